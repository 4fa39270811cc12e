// What a collision step counts and names, and where its caller's patience ends.
#include <gtest/gtest.h>

#include "sim/collision_step.h"
#include "tests/sim/step_scene.h"

namespace selvage::sim::testbed {
namespace {

/// One corner, 1 cm above the ground, is to move 2 cm. A whole impulse stops it; quarters leave 2 cm * (3/4)^n, which
/// is less than 1 cm after the third.
StepScene falling_corner(double relaxation) {
  StepScene scene;
  scene.add(triangle(1), Vec3::Zero(), 0);
  Shape tip = triangle(0.1);
  tip.x.col(2) << 0.01, 0.1, 0.1;
  scene.push(scene.add(tip, Vec3::Zero()), Vec3(0, 0, -0.02));
  scene.options.repulsion = false;
  scene.options.relaxation = relaxation;
  return scene;
}

}  // namespace

TEST(CollisionStep, RelaxationSpreadsAnImpulseOverRounds) {
  const auto rounds_with = [](double relaxation) {
    StepScene scene = falling_corner(relaxation);
    const CollisionStepResult result = scene.step();
    EXPECT_EQ(exact_defect(scene, result), "");
    return result.report.impulse_rounds;
  };
  EXPECT_EQ(rounds_with(1), 1);
  EXPECT_EQ(rounds_with(0.25), 3);
}

TEST(CollisionStep, BearsAsManyRoundsOfImpulsesAsItsCallerHasPatienceFor) {
  StepScene scene = falling_corner(0.25);
  ASSERT_EQ(scene.step().report.impulse_rounds, 3);
  const Mesh mesh = scene.mesh();
  CollisionStep step(mesh, scene.options);
  const auto status_with = [&](std::int64_t rounds) {
    const Patience patience{.impulse_rounds = rounds};
    return step(scene.V_t0, scene.V_candidate, scene.bodies(), scene.dt_s, patience).report.status;
  };
  EXPECT_EQ(status_with(3), StepStatus::kSafe);
  EXPECT_EQ(status_with(2), StepStatus::kAbandoned);
}

TEST(CollisionStep, BearsAsManyCollisionsAsItsCallerHasPatienceFor) {
  StepScene scene;
  scene.add(sheet(8), Vec3(0, 0, 0));
  scene.push(scene.add(sheet(8), Vec3(0.0031, 0.0017, 5e-3)), Vec3(1e-3, 0, -8e-3));
  const Mesh mesh = scene.mesh();
  CollisionStep step(mesh, scene.options);
  const auto status_with = [&](std::int64_t collisions) {
    const Patience patience{.collisions = collisions};
    return step(scene.V_t0, scene.V_candidate, scene.bodies(), scene.dt_s, patience).report.status;
  };
  const std::int64_t left = scene.step().report.first_collisions;
  ASSERT_GT(left, 0);
  EXPECT_EQ(status_with(left), StepStatus::kSafe);
  EXPECT_EQ(status_with(left - 1), StepStatus::kAbandoned);
}

// Cloth that comes down on the ground, and slides or not.
TEST(CollisionStep, ReportsTheContactsThatRepelledAndThoseThatRubbed) {
  const auto report_of = [](double slides_m, double friction) {
    StepScene scene;
    scene.options.friction_static = scene.options.friction_kinetic = friction;
    scene.add(sheet(2, 1), Vec3::Zero(), 0);
    const auto cloth = scene.add(sheet(3), Vec3(0.003, 0.002, 5e-4));
    scene.push(cloth, Vec3(slides_m, 0, -1e-4));
    return scene.step().report;
  };
  EXPECT_EQ(report_of(1e-3, 0.4).repulsions, 9) << "one a vertex";
  EXPECT_EQ(report_of(1e-3, 0.4).frictions, 9);
  EXPECT_EQ(report_of(1e-3, 0).repulsions, 9);
  EXPECT_EQ(report_of(1e-3, 0).frictions, 0);
  EXPECT_EQ(report_of(0, 0.4).frictions, 0) << "nothing slips";
}

TEST(CollisionStep, CountsHeldContactsAmongTheProximities) {
  StepScene scene;
  scene.add(triangle(0.1), Vec3::Zero(), 0);
  scene.push(scene.add(triangle(0.01), Vec3(0, 0, 0.8e-3)), Vec3(0, 0, -0.5e-3));
  const Mesh mesh = scene.mesh();
  CollisionStep step(mesh, scene.options);
  const std::vector<RepulsionContact> held = step.find_contacts(scene.V_t0, scene.V_candidate, scene.bodies());
  ASSERT_EQ(held.size(), 3U) << "the corners";
  const auto proximities_with = [&](std::span<const RepulsionContact> contacts) {
    return step(scene.V_t0, scene.V_candidate, scene.bodies(), scene.dt_s, {}, contacts).report.proximities;
  };
  EXPECT_EQ(proximities_with(held), proximities_with({})) << "held or found";
}

// 50 um farther apart than the thickness, and cloth falls 100: from above, or away from what lies on it.
TEST(CollisionStep, FindsContactsThatTheFallOfEitherAloneWouldPress) {
  for (const double side : {1.0, -1.0}) {
    StepScene scene;
    scene.add(triangle(0.1), Vec3::Zero());
    scene.add(triangle(0.01), Vec3(0, 0, side * 1.05e-3));
    const Mesh mesh = scene.mesh();
    CollisionStep step(mesh, scene.options);
    const auto found = [&](double fall_m) {
      return step.find_contacts(scene.V_t0, scene.V_t0, scene.bodies(), Vec3(0, 0, -fall_m)).size();
    };
    EXPECT_EQ(found(0), 0U);
    EXPECT_EQ(found(1e-4), 3U) << "the corners of the smaller, " << side;
  }
}

// What lies on one another at the start cannot be told from what moves through: that nothing moved is all that is
// known.
TEST(CollisionStep, CountsPairsThatItTakesOnTrust) {
  StepScene apart;
  apart.add(triangle(0.1), Vec3::Zero());
  apart.add(triangle(0.01), Vec3(0, 0, 2e-7));
  apart.options.max_impulse_rounds = 0;
  apart.options.max_zone_rounds = 0;
  const CollisionStepResult near = apart.step();
  EXPECT_FALSE(near.report.below_tolerance.empty());
  EXPECT_EQ(near.report.trusted_pairs, 0);

  StepScene touching;
  touching.add(sheet(3), Vec3::Zero());
  touching.push(touching.add(sheet(3), Vec3::Zero()), Vec3(0, 0, -0.01));
  const CollisionStepResult result = touching.step();
  EXPECT_EQ(result.report.status, StepStatus::kSafe);
  EXPECT_GE(result.report.trusted_pairs, 9) << "every vertex lies on another";
}

// Of the motion that is returned, not of what was tried before.
TEST(CollisionStep, CertifiesThatNothingMeetsBeforeTheEnd) {
  StepScene scene;
  scene.add(sheet(4), Vec3::Zero());
  scene.push(scene.add(sheet(4), Vec3(0.003, 0.002, 5e-3)), Vec3(0, 0, -8e-3));
  const CollisionStepResult resolved = scene.step();
  ASSERT_GT(resolved.report.first_collisions, 0);
  EXPECT_EQ(resolved.report.certificate.toi_lower, 1);
  EXPECT_GT(resolved.report.certificate.self_candidates, 0);
  EXPECT_GT(resolved.report.certificate.ee_candidates, 0);

  StepScene touching;  // cannot be told from what moves through
  touching.add(sheet(3), Vec3::Zero());
  touching.add(sheet(3), Vec3::Zero());
  const CollisionStepResult trusted = touching.step();
  ASSERT_GT(trusted.report.trusted_pairs, 0);
  EXPECT_EQ(trusted.report.certificate.toi_lower, 1);
  for (const Collision& pair : trusted.report.below_tolerance) EXPECT_EQ(pair.ccd.toi_lower, 1);
}

}  // namespace selvage::sim::testbed
