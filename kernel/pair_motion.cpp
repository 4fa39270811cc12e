#include "kernel/pair_motion.h"

#include <bit>
#include <limits>

#include "kernel/rounding.h"

namespace selvage::detail {

namespace {

constexpr int kBias = 1023;

/// 2^e for -1022 <= e <= 1023.
double power_of_two(int e) { return std::bit_cast<double>(static_cast<std::uint64_t>(e + kBias) << 52); }

/// The e with 2^(e-1) <= value < 2^e; value > 0 and finite.
int exponent_of(double value) {
  const auto bits = std::bit_cast<std::uint64_t>(value);
  const int biased = static_cast<int>(bits >> 52);
  if (biased != 0) return biased - kBias + 1;
  return static_cast<int>(std::bit_width(bits)) - 1074;
}

/// value * 2^e, |e| <= 1074: exact, unless the result is subnormal or infinite. In two factors, because 2^e need not be
/// a normal double; halves of e, because then the first product of a result that is representable cannot round.
double times_power(double value, int e) { return (value * power_of_two(e / 2)) * power_of_two(e - e / 2); }

// Adding +0 turns -0 into +0, so that equal points have equal bits in everything that follows (K5).
Double3 difference(const Double3& p, const Double3& q) {
  return {(p.x - q.x) + 0.0, (p.y - q.y) + 0.0, (p.z - q.z) + 0.0};
}

DifferencePolygon differences(PairKind kind, const std::array<Double3, 4>& x) {
  DifferencePolygon polygon;
  switch (kind) {
    case PairKind::kVf:
      polygon.corner = {difference(x[0], x[1]), difference(x[0], x[2]), difference(x[0], x[3]), Double3{}};
      polygon.edge_u = difference(x[1], x[2]);
      polygon.edge_v = difference(x[1], x[3]);
      polygon.edge_w = difference(x[2], x[3]);
      break;
    case PairKind::kEe:
      polygon.corner = {difference(x[0], x[2]), difference(x[0], x[3]), difference(x[1], x[2]), difference(x[1], x[3])};
      polygon.edge_u = difference(x[1], x[0]);
      polygon.edge_v = difference(x[2], x[3]);
      break;
    case PairKind::kSelf:
      polygon.corner = {difference(x[0], x[1]), difference(x[0], x[2]), Double3{}, Double3{}};
      polygon.edge_u = difference(x[1], x[2]);
      break;
  }
  return polygon;
}

Double3 extent_of(const DifferencePolygon& polygon) {
  return max(max(abs(polygon.corner[0]), abs(polygon.corner[1])), max(abs(polygon.corner[2]), abs(polygon.corner[3])));
}

template <class Map>
void for_each_vector(DifferencePolygon& polygon, Map map) {
  for (Double3& corner : polygon.corner) map(corner);
  map(polygon.edge_u);
  map(polygon.edge_v);
  map(polygon.edge_w);
}

Double3 interpolate(const Double3& a, const Double3& b, double s, double t) {
  return {s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
}

}  // namespace

PairMotion make_pair_motion(PairKind kind, const std::array<Double3, 4>& x_t0, const std::array<Double3, 4>& x_t1) {
  PairMotion motion;
  motion.kind = kind;
  motion.corner_count = kind == PairKind::kVf ? 3 : kind == PairKind::kEe ? 4 : 2;
  motion.t0 = differences(kind, x_t0);
  motion.t1 = differences(kind, x_t1);
  const Double3 extent = max(extent_of(motion.t0), extent_of(motion.t1));
  const double largest = max_component(extent);
  motion.exponent = largest > 0 ? exponent_of(largest) : 0;
  const double least_exact = motion.exponent > 0 ? times_power(std::numeric_limits<double>::min(), motion.exponent) : 0;
  const auto scale_value = [&motion, least_exact](double value) {
    motion.exact_scaling &= value == 0 || !(std::fabs(value) < least_exact);
    return times_power(value, -motion.exponent);
  };
  const auto scale = [scale_value](Double3& v) { v = {scale_value(v.x), scale_value(v.y), scale_value(v.z)}; };
  for_each_vector(motion.t0, scale);
  for_each_vector(motion.t1, scale);
  motion.extent = max(max(extent_of(motion.t0), extent_of(motion.t1)), {kExtentFloor, kExtentFloor, kExtentFloor});
  return motion;
}

DifferencePolygon polygon_at(const PairMotion& motion, double t) {
  const double s = 1 - t;
  DifferencePolygon polygon;
  for (std::size_t i = 0; i < kMaxCorners; ++i) {
    polygon.corner[i] = interpolate(motion.t0.corner[i], motion.t1.corner[i], s, t);
  }
  polygon.edge_u = interpolate(motion.t0.edge_u, motion.t1.edge_u, s, t);
  polygon.edge_v = interpolate(motion.t0.edge_v, motion.t1.edge_v, s, t);
  polygon.edge_w = interpolate(motion.t0.edge_w, motion.t1.edge_w, s, t);
  return polygon;
}

double scale_up(double value, int exponent) {
  const double scaled = times_power(value, exponent);
  // Exact unless the result is subnormal, where rounding may have lost up to half of the least double.
  return value > 0 && scaled < std::numeric_limits<double>::min() ? scaled + std::numeric_limits<double>::denorm_min()
                                                                  : scaled;
}

double scale_down(double value, int exponent) {
  const double scaled = times_power(value, exponent);
  if (!(scaled > 0) || scaled >= std::numeric_limits<double>::min()) return scaled;
  return scaled - std::numeric_limits<double>::denorm_min();
}

}  // namespace selvage::detail
