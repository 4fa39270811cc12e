#include "fuzz/oracle/proximity_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/proximity.h"
#include "verify/decision/exact_distance.h"

namespace selvage::fuzz {
namespace {

/// Widest bracket that still says something, relative to the largest coordinate distance. Measured over 80,000 queries:
/// below 2^-45 but for ill-conditioned pairs (needles, mixed exponents), where two features are closest to within
/// rounding and the direction is good to its square root: at most 2^-27.
constexpr double kWidthAllowance = 0x1p-24;

/// Sign of (exact distance - d).
int compare_distance(PairKind kind, const std::array<Vec3, 4>& x, double d) {
  return kind == PairKind::kEe ? verify::compare_ee_distance(raw(x), d) : verify::compare_vf_distance(raw(x), d);
}

double largest_coordinate_distance(const std::array<Vec3, 4>& x) {
  const Vec3 low = x[0].cwiseMin(x[1]).cwiseMin(x[2]).cwiseMin(x[3]);
  const Vec3 high = x[0].cwiseMax(x[1]).cwiseMax(x[2]).cwiseMax(x[3]);
  return (high - low).maxCoeff();
}

bool is_convex(PairKind kind, const std::array<double, 4>& w) {
  constexpr double kSlack = 0x1p-40;  // "up to rounding": far above it, far below anything wrong
  if (!std::all_of(w.begin(), w.end(), [](double weight) { return weight >= 0; })) return false;
  if (kind == PairKind::kEe) return std::abs(w[0] + w[1] - 1) <= kSlack && std::abs(w[2] + w[3] - 1) <= kSlack;
  return w[0] == 1 && std::abs(w[1] + w[2] + w[3] - 1) <= kSlack;
}

/// Distance of the points of the weights, relative to point 3, divided by `size`; long double carries 11 more bits.
long double witness_distance(PairKind kind, const std::array<Vec3, 4>& x, const std::array<double, 4>& w, double size) {
  using Long3 = Eigen::Matrix<long double, 3, 1>;
  const auto scaled = [&](std::size_t i) {
    return Long3((x[i].cast<long double>() - x[3].cast<long double>()) / static_cast<long double>(size));
  };
  const Eigen::Vector4d weights(w[0], w[1], w[2], w[3]);
  const Eigen::Matrix<long double, 4, 1> v = weights.cast<long double>();
  const Long3 first = kind == PairKind::kEe ? Long3(v[0] * scaled(0) + v[1] * scaled(1)) : scaled(0);
  const Long3 second = kind == PairKind::kEe ? Long3(v[2] * scaled(2)) : Long3(v[1] * scaled(1) + v[2] * scaled(2));
  return (first - second).norm();
}

bool error_bound_is_sound(const Proximity& p) {
  // Where an end of the bracket is subnormal it has been rounded outward after the bound was taken from it.
  constexpr double kNormal = std::numeric_limits<double>::min();
  if (p.distance_upper < kNormal || (p.distance_lower > 0 && p.distance_lower < kNormal)) return true;
  const auto upper = static_cast<long double>(p.distance_upper);
  const auto lower = static_cast<long double>(p.distance_lower);
  const long double error = std::sqrt((upper - lower) * (upper + lower));
  return static_cast<long double>(p.point_error_bound) >= error * (1 - 0x1p-60L);
}

ProximityDefect find_defect(PairKind kind, const std::array<Vec3, 4>& x, const Proximity& p, double size) {
  const double lower = p.distance_lower;
  const double upper = p.distance_upper;
  if (!(0 <= lower && lower <= p.distance && p.distance <= upper && std::isfinite(upper))) {
    return ProximityDefect::kOutside;
  }
  if (compare_distance(kind, x, lower) < 0) return ProximityDefect::kLowerTooHigh;
  if (compare_distance(kind, x, upper) > 0) return ProximityDefect::kUpperTooLow;
  if (!is_convex(kind, p.weights)) return ProximityDefect::kBadWeights;
  if (size > 0) {
    // Weights that sum to 1 only up to rounding move the witness by as much of the size.
    const long double slack = 0x1p-48L;
    const long double relative_upper = static_cast<long double>(upper) / static_cast<long double>(size);
    if (witness_distance(kind, x, p.weights, size) > relative_upper + slack) return ProximityDefect::kBadWeights;
  }
  return error_bound_is_sound(p) ? ProximityDefect::kNone : ProximityDefect::kBadErrorBound;
}

}  // namespace

std::string_view name_of(ProximityDefect defect) {
  switch (defect) {
    case ProximityDefect::kNone:
      return "none";
    case ProximityDefect::kLowerTooHigh:
      return "lower-too-high";
    case ProximityDefect::kUpperTooLow:
      return "upper-too-low";
    case ProximityDefect::kOutside:
      return "outside-bracket";
    case ProximityDefect::kTooWide:
      return "bracket-too-wide";
    case ProximityDefect::kBadWeights:
      return "bad-weights";
    case ProximityDefect::kBadErrorBound:
      break;
  }
  return "bad-error-bound";
}

ProximityJudgement judge_proximity(PairKind kind, const std::array<Vec3, 4>& x) {
  const Proximity proximity = pair_proximity(kind, x);
  const double size = largest_coordinate_distance(x);
  ProximityJudgement judgement;
  judgement.defect = find_defect(kind, x, proximity, size);
  judgement.exactly_zero = compare_distance(kind, x, 0) == 0;
  if (size > 0) judgement.width = (proximity.distance_upper - proximity.distance_lower) / size;
  // Below the smallest normal number the bracket's ends are whole multiples of 2^-1074.
  const double allowed = std::max(kWidthAllowance * size, 8 * std::numeric_limits<double>::denorm_min());
  if (judgement.defect == ProximityDefect::kNone && proximity.distance_upper - proximity.distance_lower > allowed) {
    judgement.defect = ProximityDefect::kTooWide;
  }
  return judgement;
}

}  // namespace selvage::fuzz
