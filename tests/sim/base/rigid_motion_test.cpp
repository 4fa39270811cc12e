#include "sim/base/rigid_motion.h"

#include <Eigen/Geometry>

#include "tests/property.h"
#include "tests/sim/mechanics.h"
#include "tests/sim/response/response_properties.h"

namespace selvage::sim::testbed {
namespace {

using selvage::testing::check_property;

}  // namespace

TEST(MomentumMotion, KeepsDistancesMomentumAndNeverAddsEnergy) {
  for (const ZoneShape shape : {ZoneShape::kSpread, ZoneShape::kLine, ZoneShape::kPoint}) {
    check_property(200, 41, [&] { prop_zone_keeps_distances_and_momentum(shape); });
  }
}

TEST(MomentumMotion, InstantaneousVelocityKeepsAngularMomentum) {
  for (const ZoneShape shape : {ZoneShape::kSpread, ZoneShape::kLine, ZoneShape::kPoint}) {
    check_property(200, 42, [&] { prop_zone_keeps_angular_momentum(shape); });
  }
}

TEST(MomentumMotion, TurnsARigidlyTurningZoneByItsOwnAngle) {
  check_property(200, 43, [] {
    Nodes nodes = random_nodes(ZoneShape::kSpread, 1);
    const Vec3 omega = vector_within(0.8);
    RC_PRE(nodes.x.size() >= 4U && omega.norm() > 1e-3);
    Vec3 center = Vec3::Zero();
    double mass_sum = 0;
    for (std::size_t i = 0; i < nodes.x.size(); ++i) {
      center += nodes.x[i] / nodes.inverse_mass[i];
      mass_sum += 1 / nodes.inverse_mass[i];
    }
    center /= mass_sum;
    for (std::size_t i = 0; i < nodes.x.size(); ++i) nodes.displacement[i] = omega.cross(nodes.x[i] - center);
    const RigidMotion rigid = momentum_motion(nodes.x, nodes.displacement, nodes.inverse_mass);
    const Eigen::Matrix3d expected = Eigen::AngleAxisd(omega.norm(), omega.normalized()).toRotationMatrix();
    RC_ASSERT((rigid.turn + Eigen::Matrix3d::Identity() - expected).norm() <= 1e-9);
    // Paper, 7.5: x_CM + dt v_CM + x_F + cos x_R + sin (omega/|omega|) x x_R.
    for (const Vec3& x : nodes.x) {
      const Vec3 axis = omega.normalized();
      const Vec3 fixed = (x - center).dot(axis) * axis;
      const Vec3 turning = x - center - fixed;
      const double angle = omega.norm();
      const Vec3 end = center + fixed + std::cos(angle) * turning + std::sin(angle) * axis.cross(turning);
      RC_ASSERT((x + rigid.displacement(x) - end).norm() <= 1e-9);
    }
  });
}

TEST(MomentumMotion, TurnsByNoMoreThan120Degrees) {
  check_property(100, 44, [] {
    const Nodes nodes = random_nodes(ZoneShape::kSpread, std::exp2(number_between(0, 990)));
    const RigidMotion rigid = momentum_motion(nodes.x, nodes.displacement, nodes.inverse_mass);
    const double cosine = (rigid.turn.trace() + 2) / 2;  // trace(R) = 1 + 2 cos
    RC_ASSERT(cosine >= std::cos(kMaxZoneAngle) - 1e-12);
    for (const Vec3& d : displacements(rigid, nodes.x)) RC_ASSERT(d.allFinite());
  });
}

// Light nodes may be as far out and as fast as heavy ones.
TEST(MomentumMotion, KeepsLinearMomentumAndDistancesFarFromTheOrigin) {
  for (const ZoneShape shape : {ZoneShape::kSpread, ZoneShape::kLine, ZoneShape::kPoint}) {
    check_property(400, 47, [&] { prop_far_zone_keeps_distances_and_momentum(shape); });
  }
}

TEST(BestFitMotion, FindsARigidScript) {
  check_property(200, 45, [] {
    Nodes nodes = random_nodes(ZoneShape::kSpread, 1);
    RC_PRE(nodes.x.size() >= 3U);
    const Vec3 axis = vector_within(1);
    RC_PRE(axis.norm() > 0.1);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(number_between(-3, 3), axis.normalized()).toRotationMatrix();
    const Vec3 shift = vector_within(10);
    const bool flat = integer_in(0, 2) == 0;
    std::vector<Vec3> end;
    for (Vec3& x : nodes.x) {
      if (flat) x.z() = 0;
      end.emplace_back(turn * x + shift);
    }
    const double spread = (nodes.x[1] - nodes.x[0]).cross(nodes.x[2] - nodes.x[0]).norm();
    RC_PRE(spread > 0.05);
    const RigidMotion rigid = best_fit_motion(nodes.x, end);
    for (std::size_t i = 0; i < end.size(); ++i) {
      RC_ASSERT((nodes.x[i] + rigid.displacement(nodes.x[i]) - end[i]).norm() <= 1e-10);
    }
    RC_ASSERT((rigid.turn + Eigen::Matrix3d::Identity() - turn).norm() <= 1e-9);
  });
}

TEST(BestFitMotion, TurnsNoMoreThanThePointsAskFor) {
  check_property(100, 46, [] {
    const Nodes nodes = random_nodes(*rc::gen::element(ZoneShape::kLine, ZoneShape::kPoint), 1);
    const Vec3 shift = vector_within(1);
    std::vector<Vec3> end;
    for (const Vec3& x : nodes.x) end.emplace_back(x + shift);
    RC_ASSERT(best_fit_motion(nodes.x, end).turn.norm() <= 1e-6);
  });
  const std::vector<Vec3> still{Vec3(0.1, 0.2, 0.3), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  EXPECT_EQ(best_fit_motion(still, still).turn.norm(), 0);
}

}  // namespace selvage::sim::testbed
