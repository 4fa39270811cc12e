// What a collision step does with vertices that follow a script: bodies that push, carry, squeeze and wait.
#include <algorithm>

#include <Eigen/Geometry>

#include "sim/collision_step.h"
#include "tests/sim/step_scene.h"

namespace selvage::sim::testbed {

TEST(ScriptedBodies, FastBodyPushesTheSheetAhead) {
  for (const double speed_m_s : {0.5, 5.0, 50.0}) {
    StepScene scene;
    const auto ball = scene.add(make_sphere(0.03, 2), Vec3(0, 0, -0.032), 0);
    const auto cloth = scene.add(sheet(10), Vec3(1e-3, 2e-3, 0));
    scene.push(ball, Vec3(0, 0, speed_m_s * scene.dt_s));
    const CollisionStepResult result = scene.step();
    SCOPED_TRACE(speed_m_s);
    EXPECT_EQ(exact_defect(scene, result), "");
    EXPECT_GT(highest(result.x, cloth), highest(scene.V_candidate, ball));
    EXPECT_TRUE(result.report.waiting_bodies.empty());
  }
}

TEST(ScriptedBodies, TurningBodyCarriesWhatItCannotAvoid) {
  StepScene scene;
  const auto box = scene.add(make_box(Vec3(0.2, 0.2, 0.02), 3), Vec3(0, 0, -0.0105), 3);
  scene.add(sheet(8), Vec3(0, 0, 0));
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.2, Vec3(1, 0.3, 0.2).normalized()).toRotationMatrix();
  for (VertexId v = box.begin; v < box.end; ++v) {
    scene.V_candidate.row(v) = (turn * scene.V_t0.row(v).transpose()).transpose();
  }
  scene.options.max_impulse_rounds = 0;
  scene.options.max_zone_rounds = 0;
  scene.options.repulsion = false;
  const CollisionStepResult result = scene.step();
  EXPECT_EQ(exact_defect(scene, result), "");
  EXPECT_GT(result.report.fail_safe_vertices, 0);
  EXPECT_TRUE(result.report.waiting_bodies.empty());
}

TEST(ScriptedBodies, ClothPinchedByTwoBodiesStopsWithAWitnessOrTheBodiesWait) {
  StepScene scene;
  const auto floor = scene.add(make_box(Vec3(0.06, 0.06, 0.02), 2), Vec3(0, 0, -0.012), 0);
  const auto press = scene.add(make_box(Vec3(0.05, 0.05, 0.02), 2), Vec3(0, 0, 0.012), 1);
  const auto cloth = scene.add(sheet(8), Vec3::Zero());
  scene.add(sheet(2), Vec3(1, 0, 0));
  scene.push(press, Vec3(0, 0, -0.01));  // 6 mm into the floor
  const CollisionStepResult stopped = scene.step();
  EXPECT_EQ(stopped.report.status, StepStatus::kStopped);
  ASSERT_TRUE(stopped.report.witness);
  EXPECT_NE(stopped.report.witness->ccd.cause, CcdCause::kEnd);
  EXPECT_EQ(stopped.x, scene.V_t0);
  EXPECT_EQ(stopped.velocity.norm(), 0);

  scene.policy = SqueezePolicy::kYield;
  const CollisionStepResult yielded = scene.step();
  EXPECT_EQ(exact_defect(scene, yielded), "");
  EXPECT_EQ(yielded.report.waiting_bodies, (std::vector<std::int32_t>{1}));
  ASSERT_FALSE(yielded.report.without_room.empty());
  EXPECT_GE(yielded.report.without_room.front(), cloth.begin);
  EXPECT_LT(yielded.report.without_room.back(), cloth.end);
  for (VertexId v = floor.begin; v < floor.end; ++v) EXPECT_EQ(yielded.x.row(v), scene.V_t0.row(v));
}

TEST(ScriptedBodies, NobodyWaitsForWhatEndsTooNearElsewhere) {
  StepScene scene;
  scene.add(make_box(Vec3(0.06, 0.06, 0.02), 2), Vec3(0, 0, -0.012), 0);
  const auto press = scene.add(make_box(Vec3(0.05, 0.05, 0.02), 2), Vec3(0, 0, 0.012), 1);
  const auto cloth = scene.add(sheet(8), Vec3::Zero());
  scene.add(sheet(2), Vec3(1, 0, 0));
  scene.add(sheet(2), Vec3(1, 0, 1e-7));  // a tenth of the tolerance above
  scene.push(press, Vec3(0, 0, -0.01));
  scene.policy = SqueezePolicy::kYield;
  scene.options.repulsion = false;
  scene.options.max_impulse_rounds = scene.options.max_zone_rounds = 0;
  const CollisionStepResult result = scene.step();
  EXPECT_EQ(result.report.waiting_bodies, (std::vector<std::int32_t>{1}));
  EXPECT_FALSE(result.report.below_tolerance.empty());
  ASSERT_FALSE(result.report.without_room.empty());
  EXPECT_LT(result.report.without_room.back(), cloth.end);
}

TEST(ScriptedBodies, BodiesThatBothMoveBothWait) {
  StepScene scene;
  const auto below = scene.add(make_box(Vec3(0.06, 0.06, 0.02), 2), Vec3(0, 0, -0.012), 7);
  const auto above = scene.add(make_box(Vec3(0.05, 0.05, 0.02), 2), Vec3(0, 0, 0.012), 4);
  const auto beside = scene.add(make_box(Vec3(0.02, 0.02, 0.02), 1), Vec3(0.3, 0, 0), 5);
  scene.add(sheet(8), Vec3::Zero());
  scene.push(below, Vec3(0, 0, 0.01));
  scene.push(above, Vec3(0, 0, -0.01));
  scene.push(beside, Vec3(0, 0, -0.01));
  scene.policy = SqueezePolicy::kYield;
  const CollisionStepResult result = scene.step();
  EXPECT_EQ(exact_defect(scene, result), "");
  EXPECT_EQ(result.report.waiting_bodies, (std::vector<std::int32_t>{4, 7}));
}

TEST(ScriptedBodies, PinsThatCrossTheirOwnClothStopOrWait) {
  StepScene scene;
  const auto cloth = scene.add(sheet(6), Vec3::Zero());
  // Two whole cloth triangles' worth of pins change places: nothing but the pins can give way.
  for (VertexId v = cloth.begin; v < cloth.end; ++v) scene.inverse_mass[static_cast<std::size_t>(v)] = 0;
  scene.V_candidate.col(0) = -scene.V_t0.col(0);
  EXPECT_EQ(scene.step().report.status, StepStatus::kStopped);
  scene.policy = SqueezePolicy::kYield;
  const CollisionStepResult result = scene.step();
  EXPECT_EQ(exact_defect(scene, result), "");
  EXPECT_EQ(result.report.waiting_bodies, (std::vector<std::int32_t>{-1}));
}

TEST(ScriptedBodies, ClothThatPinsHoldAllOverDoesNotPassThroughABody) {
  StepScene scene;
  scene.add(sheet(3), Vec3::Zero(), 0);
  const auto pinned = scene.add(sheet(3), Vec3(1e-3, 2e-3, 1e-2), 1);
  scene.push(pinned, Vec3(0, 0, -2e-2));
  const Mesh mesh = scene.mesh();
  const auto status_with = [&](std::int32_t first_pin) {
    CollisionBodies bodies = scene.bodies();
    bodies.first_pin = first_pin;
    return CollisionStep(mesh, scene.options)(scene.V_t0, scene.V_candidate, bodies, scene.dt_s).report.status;
  };
  EXPECT_EQ(status_with(1), StepStatus::kStopped);
  EXPECT_EQ(status_with(2), StepStatus::kSafe) << "two bodies may pass through each other";
}

TEST(ScriptedBodies, ABodyThatDeformsWaitsWhereItIsInTheWay) {
  StepScene scene;
  scene.policy = SqueezePolicy::kYield;
  scene.options.thickness_m = 1e-3;
  scene.add(sheet(9), Vec3(0, 0, -5e-3), 0);
  scene.add(sheet(9), Vec3(0.0031, 0.0017, 0));
  const auto lid = scene.add(sheet(9), Vec3(1e-4, 2e-4, 5e-3), 0);
  Positions& candidate = scene.V_candidate;
  const double left = candidate.col(0).minCoeff();
  for (VertexId v = lid.begin; v < lid.end; ++v) candidate(v, 2) -= 2e-1 * (candidate(v, 0) - left);
  const std::int64_t beyond = (candidate.middleRows(lid.begin, lid.end - lid.begin).col(2).array() < -5e-3).count();
  ASSERT_GT(beyond, 10) << "the lid closes through the floor, on its right";

  const CollisionStepResult rigid = scene.step();
  EXPECT_EQ(exact_defect(scene, rigid), "");
  EXPECT_EQ(rigid.report.waiting_bodies, std::vector<std::int32_t>{0});
  EXPECT_EQ(rigid.x.bottomRows(lid.end - lid.begin), scene.V_t0.bottomRows(lid.end - lid.begin));

  scene.deforms = {1};
  const CollisionStepResult result = scene.step();
  EXPECT_EQ(exact_defect(scene, result), "");
  EXPECT_EQ(result.report.waiting_bodies, std::vector<std::int32_t>{0});
  EXPECT_GE(std::ssize(result.report.waiting_vertices), beyond);
  for (const VertexId v : result.report.waiting_vertices) {
    EXPECT_GE(v, lid.begin) << "the floor does not move";
    EXPECT_LT(candidate(v, 2), 2e-3) << "what is far above the cloth goes on";
  }
}

// What is carried pushes what is carried with it, which meets nothing of the body.
TEST(ScriptedBodies, ABodyThatDeformsCarriesAHeapByTheFailSafeAlone) {
  for (const SqueezePolicy policy : {SqueezePolicy::kStop, SqueezePolicy::kYield}) {
    StepScene scene;
    scene.policy = policy;
    scene.options.repulsion = false;
    scene.options.max_impulse_rounds = scene.options.max_zone_rounds = 0;
    scene.deforms = {1};
    const auto floor = scene.add(sheet(7), Vec3::Zero(), 0);
    for (int n = 1; n <= 4; ++n) scene.add(sheet(5, 0.06), Vec3(1e-3 * n, 2e-3 * n, 2e-3 * n));
    for (VertexId v = floor.begin; v < floor.end; ++v) {
      scene.V_candidate(v, 2) += 3e-3 + 1e-2 * scene.V_t0(v, 0);  // meets the lowest sheet alone
    }
    const CollisionStepResult result = scene.step();
    EXPECT_EQ(exact_defect(scene, result), "");
    EXPECT_EQ(result.report.waiting_bodies, std::vector<std::int32_t>{}) << "all can be carried";
    EXPECT_GT(result.report.fail_safe_vertices, 50);
  }
}

}  // namespace selvage::sim::testbed
