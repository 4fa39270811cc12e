#include <cmath>
#include <limits>

#include "fuzz/draw/query_makers.h"

namespace selvage::fuzz::make {
namespace {

constexpr std::uint32_t kSmallRadius = 3;
constexpr std::uint32_t kLargeRadius = 1U << 20;

/// Small integers tie, and their products are exact in doubles; large ones touch as exactly, but no product is.
std::uint32_t choose_radius(ChoiceSource& source, std::uint32_t small) { return source.coin() ? kLargeRadius : small; }

LatticeMotion random_motion(ChoiceSource& source, std::uint32_t radius) {
  LatticeMotion motion;
  for (auto* x : {&motion.x_t0, &motion.x_t1}) {
    for (auto& point : *x) point = choose_point(source, radius);
  }
  return motion;
}

double& choose_coordinate(ChoiceSource& source, MotionQuery& query) {
  const std::size_t point = source.n(static_cast<std::uint32_t>(point_count(query.kind)));
  auto& x = source.coin() ? query.x_t1 : query.x_t0;
  return x[point][source.range(0, 2)];
}

double move_by_ulps(double x, std::int64_t ulps) {
  const double target = ulps < 0 ? -std::numeric_limits<double>::infinity() : std::numeric_limits<double>::infinity();
  for (std::int64_t i = std::abs(ulps); i > 0; --i) x = std::nextafter(x, target);
  return x;
}

}  // namespace

void nudge(ChoiceSource& source, MotionQuery& query, std::uint32_t ulps) {
  for (int moves = source.range(1, 3); moves > 0; --moves) {
    double& coordinate = choose_coordinate(source, query);
    coordinate = move_by_ulps(coordinate, source.zigzag(ulps));
  }
}

MotionQuery lattice_ulp(ChoiceSource& source, PairKind kind) {
  if (source.one_in(8)) return source.coin() ? near_miss(source, kind) : rounded_contact(source, kind);
  MotionQuery query;
  if (source.coin()) {
    query = to_query(kind, random_motion(source, static_cast<std::uint32_t>(source.range(1, 3))));
  } else {
    const ContactPlace place_of = choose_any_place(source);
    query = contact(source, kind, choose_any_time(source), place_of, Grid::kLattice);
  }
  nudge(source, query, 3);
  return query;
}

MotionQuery degenerate(ChoiceSource& source, PairKind kind) {
  LatticeMotion motion = random_motion(source, 2);
  const auto count = static_cast<std::uint32_t>(point_count(kind));
  for (int edits = source.range(1, 3); edits > 0; --edits) {
    const std::size_t to = source.n(count);
    const std::size_t from = source.n(count);
    const std::size_t other = source.n(count);
    const std::int64_t factor = source.zigzag(2);
    const std::uint32_t when = source.n(3);  // both ends, start, end
    // factor 0 makes a duplicate of `from`, others put `to` on the line through `from` and `other`.
    const auto onto_line = [&](LatticePoints& x) { x[to] = x[from] + factor * (x[other] - x[from]); };
    if (when != 2) onto_line(motion.x_t0);
    if (when != 1) onto_line(motion.x_t1);
  }
  return to_query(kind, motion);
}

MotionQuery in_plane(ChoiceSource& source, PairKind kind) {
  const std::uint32_t radius = choose_radius(source, 2);
  const std::array<LatticePoint, 2> plane{choose_point(source, radius), choose_point(source, radius)};
  const LatticePoint shift = choose_point(source, radius);
  LatticeMotion motion;
  for (auto& point : motion.x_t0) point = choose_in_plane(source, plane, 2);
  for (auto& point : motion.x_t1) point = choose_in_plane(source, plane, 2) + shift;
  return to_query(kind, motion);
}

MotionQuery near_coplanar(ChoiceSource& source, PairKind kind) {
  std::array<LatticePoint, 2> plane{choose_point(source, 2), choose_point(source, 2)};
  const std::int64_t flatness = std::int64_t{1} << source.range(0, 40);
  for (auto& vector : plane) vector *= flatness;
  LatticeMotion motion;
  for (auto* x : {&motion.x_t0, &motion.x_t1}) {
    for (auto& point : *x) {
      const LatticePoint beside = choose_point(source, 1);
      point = choose_in_plane(source, plane, kSmallRadius) + beside;
    }
  }
  return to_query(kind, motion);
}

MotionQuery same_velocity(ChoiceSource& source, PairKind kind) {
  LatticeMotion motion = random_motion(source, 2);
  if (source.coin()) {
    Placement x = choose_placement(source, choose_radius(source, kSmallRadius));
    x.gap.setZero();
    motion.x_t0 = place(kind, choose_weights(source, kind, choose_any_place(source)), x);
  }
  LatticePoint velocity = choose_point(source, kSmallRadius);
  velocity *= std::int64_t{1} << source.n(31);
  for (std::size_t i = 0; i < 4; ++i) motion.x_t1[i] = motion.x_t0[i] + velocity;
  return to_query(kind, motion);
}

MotionQuery no_motion(ChoiceSource& source, PairKind kind) {
  MotionQuery query = same_velocity(source, kind);
  query.x_t1 = query.x_t0;
  return query;
}

MotionQuery rigid_rotation(ChoiceSource& source, PairKind kind) {
  struct Turn {
    std::int64_t cos, sin, radius;
  };
  constexpr std::array<Turn, 6> kTurns{{{3, 4, 5}, {4, 3, 5}, {0, 1, 1}, {-3, 4, 5}, {5, 12, 13}, {-1, 0, 1}}};
  const Turn turn = kTurns[source.n(kTurns.size())];
  Placement x = choose_placement(source, choose_radius(source, kSmallRadius));
  if (!source.one_in(4)) x.gap.setZero();
  const LatticePoints pose = place(kind, choose_weights(source, kind, choose_any_place(source)), x);
  const Eigen::Index axis = source.range(0, 2);
  const Eigen::Index u = (axis + 1) % 3;
  const Eigen::Index v = (axis + 2) % 3;
  const LatticePoint drift = choose_point(source, 2);  // of the first point alone
  LatticeMotion motion;
  for (std::size_t i = 0; i < 4; ++i) {
    motion.x_t0[i] = turn.radius * pose[i];
    motion.x_t1[i] = motion.x_t0[i];
    motion.x_t1[i][u] = turn.cos * pose[i][u] - turn.sin * pose[i][v];
    motion.x_t1[i][v] = turn.sin * pose[i][u] + turn.cos * pose[i][v];
  }
  if (source.coin()) motion.x_t0[0] += drift;
  if (source.coin()) motion.x_t1[0] -= drift;
  return to_query(kind, motion);
}

}  // namespace selvage::fuzz::make
