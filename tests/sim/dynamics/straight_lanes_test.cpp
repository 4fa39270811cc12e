// What eight contacts at once are told of the bodies below them, against one contact at a time.
#include "sim/dynamics/straight_lanes.h"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace selvage::sim {
namespace {

using Kind = StraightSurface::Kind;

std::mt19937_64& engine() {
  static std::mt19937_64 of_lanes(1);
  return of_lanes;
}

Vec3 any_point() {
  std::uniform_real_distribution<double> coordinate(-1, 1);
  Vec3 point;
  for (double& x : point) x = coordinate(engine());
  return point;
}

Positions four_points() {
  Positions V(4, 3);
  for (Eigen::Index row = 0; row < 4; ++row) V.row(row) = any_point();
  return V;
}

StraightSurface any_surface() {
  constexpr std::array<Kind, 3> kKinds{Kind::kCorner, Kind::kLine, Kind::kPlane};
  constexpr double kMax = 4;  // twice the distance
  const Vec3 extents = kMax * any_point().cwiseAbs();
  return {kKinds.at(engine()() % 3), {0, 1, 2, 3}, {extents[0], extents[1]}};
}

/// On the edge of the body, from vertex `first` on: within it, or at one of its ends.
std::array<double, 4> any_weights(std::uint8_t first) {
  constexpr std::array<double, 3> kShares{0, 0.25, 1};
  const double share = kShares.at(engine()() % 3);
  std::array<double, 4> weights{0.5, 0.5, -0.5, -0.5};
  weights.at(first) = share - 1;
  weights.at(first + 1U) = -share;
  return weights;
}

}  // namespace

TEST(StraightLanes, TurnDirectionsAsOneContactAlone) {
  constexpr double kShare = 0.3, kDistance = 2;
  for (int round = 0; round < 200; ++round) {
    const PairKind kind = round % 2 == 0 ? PairKind::kEe : PairKind::kVf;
    const Positions V_t0 = four_points(), V_t1 = four_points();
    PackStraight pack;
    PackNearest nearest{}, expected{};
    LaneMask beyond = 0;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      StraightFeature feature{{any_surface(), any_surface(), any_surface()}, {}};
      if (kind == PairKind::kVf) feature.parts[1] = feature.parts[2] = {};
      feature.first = kind == PairKind::kEe && lane % 2 == 1 ? 2 : 0;
      set_straight(kind, feature, V_t0, V_t1, lane, pack);
      const std::array<double, 4> weights = any_weights(feature.first);
      const StraightSurface& surface = feature.parts.at(feature.part(kind, weights));
      const Vec3 t0 = surface.direction(V_t0), t1 = surface.direction(V_t1);
      Vec3 direction = any_point().normalized();
      if (lane == 0 && surface.kind != Kind::kCorner) {  // in it: nothing is left
        const Vec3 now = (t0 + kShare * (t1 - t0)).normalized();
        direction = surface.kind == Kind::kLine ? now : now.unitOrthogonal();
      }
      const Across turned = across(surface, feature.extent_share(kind, weights), (t0 + kShare * (t1 - t0)).normalized(),
                                   direction, kDistance);
      if (turned.is_beyond) beyond |= only_lane(lane);
      nearest.distance[lane] = kDistance;
      expected.distance[lane] = kDistance * turned.unit.dot(direction);  // of the same two points
      for (std::size_t k = 0; k < 4; ++k) nearest.weights[k][lane] = weights[k];
      for (std::size_t k = 0; k < 3; ++k) {
        nearest.direction[k][lane] = direction[static_cast<Eigen::Index>(k)];
        expected.direction[k][lane] = turned.unit[static_cast<Eigen::Index>(k)];
      }
    }
    EXPECT_EQ(turn_across(pack, kShare, nearest), beyond) << round;
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      EXPECT_LT((vector_in(nearest.direction, lane) - vector_in(expected.direction, lane)).norm(), 1e-12) << lane;
      EXPECT_NEAR(nearest.distance[lane], expected.distance[lane], 1e-12) << lane;
    }
  }
}

}  // namespace selvage::sim
