#include "sim/response/step_limit.h"

#include "sim/base/sorted_once.h"
#include "tests/property.h"
#include "tests/sim/mechanics.h"
#include "tests/sim/step_scene.h"

namespace selvage::sim::testbed {
namespace {

Shape lone_triangle(double size_m) {
  Shape shape;
  shape.x.resize(3, 3);
  shape.x << 0, 0, 0, size_m, 0, 0, 0, size_m, 0;
  shape.triangles = {{0, 1, 2}};
  return shape;
}

std::vector<std::uint8_t> flags_of(const StepScene& scene) {
  std::vector<std::uint8_t> is_cloth;
  for (const std::int32_t body : scene.body) is_cloth.push_back(static_cast<std::uint8_t>(body < 0));
  return is_cloth;
}

/// What the fail-safe begins with: the motion of a scene, and what collides in it.
struct Tracked {
  explicit Tracked(const StepScene& scene)
      : mesh(scene.mesh()),
        hierarchy(mesh),
        bodies(scene.bodies()),
        groups(bodies),
        is_cloth(flags_of(scene)),
        contacts(mesh, {}, {}),
        tracker(mesh, hierarchy, contacts, 4096, is_cloth) {
    motion.start(scene.V_t0, scene.V_candidate, Precision::kFloat64);
    groups.observe(motion);
    tracker.start(motion);
  }
  Mesh mesh;
  BoxHierarchy hierarchy;
  CollisionBodies bodies;
  ScriptedGroups groups;
  std::vector<std::uint8_t> is_cloth;  ///< or a pin: two bodies do not meet
  ContactTable contacts;
  CollisionTracker tracker;
  StepMotion motion;
};

}  // namespace

TEST(Clearance, IsTheLeastDistanceToWhatAVertexMustNotMeet) {
  StepScene scene;
  scene.add(lone_triangle(1), Vec3::Zero());
  scene.add(lone_triangle(0.1), Vec3(0.2, 0.2, 0.05));
  const Mesh mesh = scene.mesh();
  BoxHierarchy hierarchy(mesh);
  const std::vector<std::uint8_t> all(6, 1);
  const std::vector<double> near = clearance(mesh, hierarchy, scene.V_t0, 1, all);
  for (const double distance : near) EXPECT_NEAR(distance, 0.05, 1e-12);  // the gap between the triangles
  scene.V_t0.bottomRows(3).col(2).setConstant(0.5);
  const std::vector<double> far = clearance(mesh, hierarchy, scene.V_t0, 1, all);
  for (std::size_t v = 0; v < 3; ++v) EXPECT_NEAR(far[v], 0.5, 1e-12);
  for (std::size_t v = 3; v < 6; ++v)
    EXPECT_NEAR(far[v], 0.1 / std::sqrt(2), 1e-12);  // its own lone_triangle's altitude
  for (const double distance : clearance(mesh, hierarchy, scene.V_t0, 0.01, all)) EXPECT_EQ(distance, 0.01);
  const std::vector<std::uint8_t> one{1, 0, 0, 0, 0, 0};
  const std::vector<double> flagged = clearance(mesh, hierarchy, scene.V_t0, 1, one);
  EXPECT_NEAR(flagged[0], 0.5, 1e-12);
  for (std::size_t v = 1; v < 6; ++v) EXPECT_EQ(flagged[v], 1);
}

TEST(Clearance, OfALoneFaceIsItsLeastAltitudeWhicheverThatIs) {
  for (int first = 0; first < 3; ++first) {
    Shape shape = lone_triangle(1);
    shape.triangles = {{first, (first + 1) % 3, (first + 2) % 3}};
    StepScene scene;
    scene.add(shape, Vec3::Zero());
    const Mesh mesh = scene.mesh();
    BoxHierarchy hierarchy(mesh);
    for (const double distance : clearance(mesh, hierarchy, scene.V_t0, 2, std::vector<std::uint8_t>(3, 1))) {
      EXPECT_NEAR(distance, 1 / std::sqrt(2), 1e-12) << first;
    }
  }
}

TEST(Clearance, VerticesWithinABallOfHalfOfItNeverTouch) {
  // The claim behind kLimited, played with the exact checker at almost the full half.
  selvage::testing::check_property(60, 71, [] {
    StepScene scene;
    const double gap_m = std::exp2(number_between(-20, -3));
    for (int layer = 0; layer < 2; ++layer) scene.add(make_sheet(3, 3, 0.1, 0.1), Vec3(0, 0, gap_m * layer));
    for (Eigen::Index v = 0; v < scene.V_t0.rows(); ++v) scene.V_t0.row(v) += vector_within(0.4 * gap_m).transpose();
    const Mesh mesh = scene.mesh();
    BoxHierarchy hierarchy(mesh);
    const std::vector<std::uint8_t> all(static_cast<std::size_t>(mesh.vertex_count), 1);
    const std::vector<double> distance = clearance(mesh, hierarchy, scene.V_t0, 1, all);
    CollisionStepResult moved;
    moved.report.status = StepStatus::kSafe;
    moved.x = scene.V_t0;
    moved.velocity = Positions::Zero(mesh.vertex_count, 3);
    for (Eigen::Index v = 0; v < scene.V_t0.rows(); ++v) {
      const Vec3 direction = vector_within(1);
      RC_PRE(direction.norm() > 0);
      moved.x.row(v) += (0.499 * distance[static_cast<std::size_t>(v)] * direction.normalized()).transpose();
    }
    RC_ASSERT(exact_defect(scene, moved) == "");
  });
}

TEST(FailSafe, ARoundLimitsEveryVertexOfACollidingPair) {
  StepScene scene;
  scene.add(lone_triangle(1), Vec3::Zero());
  const StepScene::Part above = scene.add(lone_triangle(0.5), Vec3(0.1, 0.1, 0.05));
  scene.push(above, Vec3(0.01, 0, -1));
  Tracked step(scene);
  ASSERT_TRUE(step.tracker.has_motion_collision());
  std::vector<std::uint8_t> collides(6, 0);
  for (const Collision& collision : step.tracker.collisions()) {
    for (const VertexId v : step.tracker.vertices(collision)) collides[static_cast<std::size_t>(v)] = 1;
  }

  StepLimiter limiter(step.mesh, step.hierarchy, step.groups, 1);
  ASSERT_FALSE(limiter.restrain(step.tracker, step.motion));
  EXPECT_EQ(std::ssize(limiter.restrained()), std::ranges::count(collides, 1));
  const std::vector<double> distance = clearance(step.mesh, step.hierarchy, scene.V_t0, 1, step.is_cloth);
  for (std::size_t v = 0; v < collides.size(); ++v) {
    if (collides[v] == 0) continue;
    const auto row = static_cast<Eigen::Index>(v);
    const double moved_m = (step.motion.x().row(row) - scene.V_t0.row(row)).norm();
    EXPECT_LE(moved_m, 1.001 * kBallShare * distance[v]) << v;
    if (v < 3) continue;
    EXPECT_GE(moved_m, 0.999 * kBallShare * distance[v]) << "it would go farther";
  }
}

TEST(FailSafe, WhatEndsTooNearIsNotHeldBack) {
  StepScene scene;
  scene.add(lone_triangle(1), Vec3::Zero());
  const StepScene::Part above = scene.add(lone_triangle(0.5), Vec3(0.1, 0.1, 0.05));
  scene.push(above, Vec3(0, 0, 0.5 * scene.options.tolerance_m - 0.05));
  Tracked step(scene);
  ASSERT_FALSE(step.tracker.collisions().empty());
  ASSERT_FALSE(step.tracker.has_motion_collision());
  StepLimiter limiter(step.mesh, step.hierarchy, step.groups, 1);
  EXPECT_FALSE(limiter.restrain(step.tracker, step.motion));
  EXPECT_TRUE(limiter.restrained().empty());
  EXPECT_EQ(step.motion.x(), scene.V_candidate);
}

TEST(FailSafe, BodiesOfAllPlacesWithoutRoomAreNamedAtOnce) {
  // In three places a body goes through cloth that is pinned: nothing can give way.
  StepScene scene;
  constexpr std::int32_t kPlaces = 3;
  std::vector<StepScene::Part> moving;
  for (std::int32_t place = 0; place < kPlaces; ++place) {
    const Vec3 at(10 * place, 0, 0);
    const StepScene::Part pinned = scene.add(lone_triangle(1), at);
    for (VertexId v = pinned.begin; v < pinned.end; ++v) scene.inverse_mass[static_cast<std::size_t>(v)] = 0;
    moving.push_back(scene.add(lone_triangle(0.5), at + Vec3(0.1, 0.1, 0.05), place));
  }
  scene.add(lone_triangle(1), Vec3(-10, 0, 0));
  const StepScene::Part falls = scene.add(lone_triangle(0.5), Vec3(-9.9, 0.1, 0.05));
  for (const StepScene::Part& part : moving) scene.push(part, Vec3(0, 0, -0.1));
  scene.push(falls, Vec3(0, 0, -0.1));
  Tracked step(scene);
  StepLimiter limiter(step.mesh, step.hierarchy, step.groups, 1);
  const auto conflict = limiter.restrain(step.tracker, step.motion);
  ASSERT_TRUE(conflict);
  std::vector<std::int32_t> named;
  for (const GroupId group : conflict->groups) named.push_back(step.groups.body(group));
  std::ranges::sort(named);
  EXPECT_EQ(named, (std::vector<std::int32_t>{0, 1, 2}));
  EXPECT_FALSE(conflict->vertices.empty());
  for (const VertexId v : conflict->vertices) {
    EXPECT_GE(scene.body[static_cast<std::size_t>(v)], 0) << "pins are at rest, cloth is not scripted";
  }
  EXPECT_EQ(step.motion.x(), scene.V_candidate) << "other cloth is not held back yet";
}

namespace {

/// What blocks the bodies of a scene in which nothing can give way any more.
std::vector<Blockage> blockages_of(const StepScene& scene, std::int32_t first_pin = 100) {
  Tracked step(scene);
  step.bodies.first_pin = first_pin;
  const ScriptedGroups groups = [&] {
    ScriptedGroups of_bodies(step.bodies);
    of_bodies.observe(step.motion);
    return of_bodies;
  }();
  StepLimiter limiter(step.mesh, step.hierarchy, groups, 1);
  for (;;) {
    if (const auto conflict = limiter.restrain(step.tracker, step.motion)) return conflict->blockages;
    step.tracker.update(step.motion);
    if (!step.tracker.has_motion_collision()) return {};
  }
}

/// A body above cloth, and one below.
StepScene pressed_cloth(double upper_z, double lower_z) {
  StepScene scene;
  scene.add(lone_triangle(0.2), Vec3(0.1, 0.1, 0));
  const StepScene::Part upper = scene.add(lone_triangle(1), Vec3(0, 0, 0.05), 0);
  const StepScene::Part lower = scene.add(lone_triangle(1), Vec3(0, 0, -0.05), 1);
  scene.push(upper, Vec3(0, 0, upper_z));
  scene.push(lower, Vec3(0, 0, lower_z));
  return scene;
}

}  // namespace

TEST(FailSafe, SaysInWhichDirectionABodyCannotGoOn) {
  const std::vector<Blockage> found = blockages_of(pressed_cloth(-0.2, 0));
  ASSERT_FALSE(found.empty());
  for (const Blockage& blockage : found) {
    EXPECT_EQ(blockage.body, 0) << "the other one does not move";
    EXPECT_EQ(blockage.vertex, Blockage::kWholeBody);
    EXPECT_LT((blockage.direction - Vec3::UnitZ()).norm(), 1e-9);
    EXPECT_GT(blockage.at_m.x(), 0.09) << "where the cloth is";
    EXPECT_LT(blockage.at_m.x(), 0.31);
  }
}

TEST(FailSafe, SaysItOfBothThatCloseAndOfNoneThatGoesAway) {
  bool of_upper = false, of_lower = false;
  for (const Blockage& blockage : blockages_of(pressed_cloth(-0.2, 0.3))) {
    (blockage.body == 0 ? of_upper : of_lower) = true;
    EXPECT_LT((blockage.direction - (blockage.body == 0 ? 1 : -1) * Vec3::UnitZ()).norm(), 1e-9);
  }
  EXPECT_TRUE(of_upper);
  EXPECT_TRUE(of_lower);
  // The lower one comes from behind.
  const std::vector<Blockage> pursued = blockages_of(pressed_cloth(0.1, 0.5));
  ASSERT_FALSE(pursued.empty());
  for (const Blockage& blockage : pursued) EXPECT_EQ(blockage.body, 1);
}

TEST(FailSafe, SaysWhichVerticesOfABodyThatDeformsCannotGoOn) {
  StepScene scene = pressed_cloth(-0.2, 0);
  scene.deforms = {1, 0};
  std::vector<VertexId> vertices;
  for (const Blockage& blockage : blockages_of(scene)) {
    EXPECT_EQ(blockage.body, 0);
    EXPECT_LT((blockage.direction - Vec3::UnitZ()).norm(), 1e-9);
    EXPECT_EQ(blockage.at_m, Vec3(scene.V_t0.row(blockage.vertex)));
    vertices.push_back(blockage.vertex);
  }
  keep_sorted_once(vertices);
  EXPECT_EQ(vertices, (std::vector<VertexId>{3, 4, 5})) << "all of the face that presses";
}

TEST(FailSafe, SaysNothingOfPins) { EXPECT_TRUE(blockages_of(pressed_cloth(-0.2, 0), 0).empty()); }

TEST(FailSafe, LimitsOnlyWhatCollides) {
  // One vertex is thrown through the other sheet; without responses only the vertices it meets are held back.
  StepScene scene;
  scene.add(make_sheet(9, 9, 0.1, 0.1), Vec3::Zero());
  scene.add(make_sheet(9, 9, 0.1, 0.1), Vec3(0.001, 0.002, 0.01));
  scene.V_candidate(40, 2) += 0.02;
  scene.options.repulsion = false;
  scene.options.max_impulse_rounds = 0;
  scene.options.max_zone_rounds = 0;
  const CollisionStepResult result = scene.step();
  EXPECT_EQ(exact_defect(scene, result), "");
  EXPECT_GT(result.report.fail_safe_vertices, 0);
  EXPECT_LT(result.report.fail_safe_vertices, 20);
  EXPECT_LE(std::abs(result.x(40, 2) - scene.V_t0(40, 2)), kBallShare * scene.options.thickness_m);
}

// Two ends of a body that rise differently, each below a sheet of its own.
TEST(FailSafe, CarriesClothAsFarAsWhatItMeetsOfABodyThatDeforms) {
  StepScene scene;
  scene.deforms = {1};
  scene.options.repulsion = false;
  scene.options.max_impulse_rounds = scene.options.max_zone_rounds = 0;
  for (const double rises_m : {5e-3, 2e-2}) {
    const Vec3 at(100 * rises_m, 0, 0);
    const StepScene::Part end = scene.add(make_sheet(4, 4, 0.1, 0.1), at, 0);
    const Positions candidate = scene.V_candidate;
    scene.add(make_sheet(3, 3, 0.05, 0.05), at + Vec3(1e-3, 2e-3, 2e-3));
    scene.V_candidate.topRows(candidate.rows()) = candidate;
    for (VertexId v = end.begin; v < end.end; ++v) scene.V_candidate(v, 2) += rises_m * (1 + 0.1 * scene.V_t0(v, 1));
  }
  scene.V_candidate.topRows(16).col(2).array() = scene.V_t0.topRows(16).col(2).array() + 5e-3;
  const CollisionStepResult result = scene.step();
  EXPECT_EQ(exact_defect(scene, result), "");
  EXPECT_GT(result.report.fail_safe_vertices, 0);
}

}  // namespace selvage::sim::testbed
