#include "sim/bodies/blocked_ways.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "sim/base/rigid_motion.h"

namespace selvage::sim {
namespace {

/// Blockages that are nearly parallel, as those of a flat sole, are met in the first. Out of a narrow wedge the way is
/// long, and rounds lead along it slowly: in so many by nine times what leads into it at most, for any angle.
constexpr int kRounds = 50;

struct Bound {
  Vec3 direction;
  double least_m;  ///< of the translation along it
  double multiplier = 0;
};

/// Hildreth's method: the dual problem, one multiplier after the other.
Vec3 least_translation(std::vector<Bound>& bounds) {
  Vec3 translation = Vec3::Zero();
  for (int round = 0; round < kRounds; ++round) {
    double changed = 0;
    for (Bound& bound : bounds) {
      const double change = std::max(bound.least_m - bound.direction.dot(translation), -bound.multiplier);
      bound.multiplier += change;
      translation += change * bound.direction;
      changed = std::max(changed, std::abs(change));
    }
    if (changed == 0) break;
  }
  return translation;
}

bool are_of_same(const Blockage& a, const Blockage& b) { return a.body == b.body && a.vertex == b.vertex; }

/// Of the same body or vertex.
bool takes_place(const Blockage& later, const Blockage& earlier, double reach_m) {
  return (later.at_m - earlier.at_m).norm() < reach_m && later.direction.dot(earlier.direction) > kSameDirection;
}

}  // namespace

void BlockedWays::start_step(double time_s) {
  std::erase_if(ways_, [&](const BlockedWay& way) { return way.until_s <= time_s; });
  at_start_ = ways_.size();
  time_s_ = time_s;
}

bool BlockedWays::add(std::span<const Blockage> blockages) {
  std::vector<BlockedWay> added;
  for (const Blockage& blockage : blockages) {
    const auto known = std::span(ways_).subspan(at_start_);
    if (std::ranges::any_of(known, [&](const BlockedWay& way) { return are_of_same(way.blockage, blockage); }))
      continue;
    added.push_back({blockage, time_s_ + kBlockedTime_s, kBackShare * thickness_m_});
  }
  const auto is_replaced = [&](const BlockedWay& old) {
    return std::ranges::any_of(added, [&](const BlockedWay& way) {
      return are_of_same(way.blockage, old.blockage) &&
             takes_place(way.blockage, old.blockage, kReachThicknesses * thickness_m_);
    });
  };
  const auto first_of_step = ways_.begin() + static_cast<std::ptrdiff_t>(at_start_);
  const auto end_of_old = std::remove_if(ways_.begin(), first_of_step, is_replaced);
  at_start_ = static_cast<std::size_t>(end_of_old - ways_.begin());
  ways_.erase(end_of_old, first_of_step);
  ways_.insert(ways_.end(), added.begin(), added.end());
  return !added.empty();
}

bool BlockedWays::lead_round(std::int32_t body, std::span<const VertexId> vertices, const Positions& x, double dt_s,
                             Positions& x_t1) const {
  std::vector<BlockedWay> of_whole, of_vertices;
  for (const BlockedWay& way : ways_) {
    if (way.blockage.body != body) continue;
    (way.blockage.vertex == Blockage::kWholeBody ? of_whole : of_vertices).push_back(way);
  }
  if (!of_vertices.empty()) return lead_vertices_round(of_vertices, vertices, x, dt_s, x_t1);
  if (of_whole.empty()) return false;
  const RigidMotion motion = best_fit_motion(x, x_t1);
  std::vector<Bound> bounds;
  for (const BlockedWay& way : of_whole) {
    const Vec3& direction = way.blockage.direction;
    bounds.push_back({direction, back_m(way, dt_s) - direction.dot(motion.displacement(way.blockage.at_m))});
  }
  const Vec3 translation = least_translation(bounds);
  if (translation.isZero(0)) return false;
  x_t1.rowwise() += translation.transpose();
  return true;
}

bool BlockedWays::lead_vertices_round(std::span<const BlockedWay> ways, std::span<const VertexId> vertices,
                                      const Positions& x, double dt_s, Positions& x_t1) const {
  const double reach_m = kReachThicknesses * thickness_m_;
  std::vector<Eigen::RowVector3d> at;
  Eigen::AlignedBox3d near;
  for (const BlockedWay& way : ways) {
    at.emplace_back(x.row(std::ranges::lower_bound(vertices, way.blockage.vertex) - vertices.begin()));
    near.extend(at.back().transpose());
  }
  bool any_moved = false;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    if (near.squaredExteriorDistance(Vec3(x.row(i))) >= reach_m * reach_m) continue;
    const Vec3 motion = x_t1.row(i) - x.row(i);
    std::vector<Bound> bounds;
    for (std::size_t k = 0; k < ways.size(); ++k) {
      const double distance_m = (x.row(i) - at[k]).norm();
      const Vec3& direction = ways[k].blockage.direction;
      const bool is_blocked = vertices[static_cast<std::size_t>(i)] == ways[k].blockage.vertex;
      const bool goes_along = distance_m < reach_m && direction.dot(motion) < 0;
      if (!is_blocked && !goes_along) continue;
      const double back = back_m(ways[k], dt_s) * (1 - distance_m / reach_m);
      bounds.push_back({direction, back - direction.dot(motion)});
    }
    const Vec3 translation = least_translation(bounds);
    if (translation.isZero(0)) continue;
    x_t1.row(i) += translation.transpose();
    any_moved = true;
  }
  return any_moved;
}

void BlockedWays::end_step(double dt_s) {
  for (BlockedWay& way : ways_) way.back_m -= back_m(way, dt_s);
}

double BlockedWays::back_m(const BlockedWay& way, double dt_s) const {
  return std::min(way.back_m, dt_s * thickness_m_ / kCatchUpTime_s);
}

}  // namespace selvage::sim
