#include "fuzz/oracle/closest_approach.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <vector>

#include "kernel/proximity.h"

namespace selvage::fuzz {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Times [first, last] not decided yet; the estimate only orders the work, no proof rests on it.
struct Interval {
  double first, last, estimate;
  friend bool operator<(const Interval& a, const Interval& b) { return a.estimate > b.estimate; }
};

double speed_upper(const MotionQuery& query, std::size_t i, std::size_t j) {
  // Each of the 6 roundings costs 2^-53 of |coordinate differences|, which may cancel: bounded by the larger of the two
  // differences, not by the result.
  const Vec3 apart_t0 = query.x_t0[i] - query.x_t0[j];
  const Vec3 apart_t1 = query.x_t1[i] - query.x_t1[j];
  const Vec3 change = apart_t1 - apart_t0;
  const Vec3 lost = (apart_t0.cwiseAbs() + apart_t1.cwiseAbs() + change.cwiseAbs()) * 0x1p-52;
  const Vec3 upper = change.cwiseAbs() + lost;
  return std::hypot(upper.x(), upper.y(), upper.z()) * (1 + 0x1p-50) + std::numeric_limits<double>::denorm_min();
}

}  // namespace

double rounded_distance(const MotionQuery& query, double t) {
  // Seen from a point that goes along: far from the origin, or fast, positions would round by more than the features
  // are apart. Differences of the largest coordinates are beyond the domain, and stay as they are.
  const bool is_far_out = max_coordinate(query) > kMaxCoordinate / 2;
  const Vec3 origin_t0 = is_far_out ? Vec3(Vec3::Zero()) : query.x_t0[0];
  const Vec3 origin_t1 = is_far_out ? Vec3(Vec3::Zero()) : query.x_t1[0];
  std::array<Vec3, 4> x;
  for (std::size_t i = 0; i < 4; ++i) x[i] = (1 - t) * (query.x_t0[i] - origin_t0) + t * (query.x_t1[i] - origin_t1);
  return pair_proximity(query.kind, x).distance;
}

double relative_speed_upper(const MotionQuery& query) {
  double speed = 0;
  const bool edges = query.kind == PairKind::kEe;
  for (std::size_t i = 0; i < (edges ? 2U : 1U); ++i) {
    for (std::size_t j = edges ? 2 : 1; j < static_cast<std::size_t>(point_count(query.kind)); ++j) {
      speed = std::max(speed, speed_upper(query, i, j));
    }
  }
  return speed;
}

Approach closest_approach(const MotionQuery& query, double d, std::span<const double> hints, int max_tests) {
  int tests = 0;
  for (const double t : hints) {
    if (t < 0 || t > 1) continue;
    ++tests;
    if (within_at(query, t, d)) return Approach::kWithin;
  }
  const double speed = relative_speed_upper(query);
  std::priority_queue<Interval> open;
  open.push({0, 1, 0});
  while (!open.empty()) {
    const auto [first, last, estimate] = open.top();
    open.pop();
    const double middle = first + (last - first) / 2;
    const double radius = std::nextafter(std::max(middle - first, last - middle), kInfinity);
    const double reach = std::nextafter(d + std::nextafter(speed * radius, kInfinity), kInfinity);
    tests += 2;
    if (tests > max_tests) return Approach::kUnknown;
    if (within_at(query, middle, d)) return Approach::kWithin;
    if (std::isfinite(reach) && !within_at(query, middle, reach)) continue;
    if (middle <= first || middle >= last) return Approach::kUnknown;  // neighbouring doubles
    const double half_motion = speed * radius / 2;
    for (const auto& [from, to] : {std::pair{first, middle}, std::pair{middle, last}}) {
      open.push({from, to, rounded_distance(query, from + (to - from) / 2) - half_motion});
    }
  }
  return Approach::kBeyond;
}

}  // namespace selvage::fuzz
