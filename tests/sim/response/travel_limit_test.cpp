// Candidates that are cut back before the step: out of the domain, or where far too much would meet on the way.
#include "sim/response/travel_limit.h"

#include <random>
#include <utility>

#include "sim/collision_step.h"
#include "tests/sim/step_scene.h"

namespace selvage::sim::testbed {

TEST(CollisionStep, CandidatesBeyondTheDomainAreCutNotRefused) {
  for (const double far : {0x1.8p+1000, 1e308}) {  // S1: any finite candidate
    StepScene scene;
    scene.add(sheet(3), Vec3(0, 0, 0));
    const auto upper = scene.add(sheet(3), Vec3(0.003, 0.002, 5e-3));
    scene.V_candidate.row(upper.begin) << far, -far, -far;
    scene.V_candidate.row(upper.begin + 4) << 0, 0, -far;
    const CollisionStepResult result = scene.step();
    SCOPED_TRACE(far);
    ASSERT_EQ(result.report.input_error, InputError::kNone);
    EXPECT_EQ(exact_defect(scene, result), "");
    EXPECT_LE(result.x.cwiseAbs().maxCoeff(), kMaxCoordinate);
  }
}

// Of 128 vertices 75,000 pairs would touch there.
TEST(CollisionStep, AMeshAtOnePointIsCutBackBeforeAllPairsAreListed) {
  StepScene scene;
  scene.add(sheet(8), Vec3::Zero());
  scene.add(sheet(8), Vec3(0, 0, 0.5));
  ASSERT_EQ(scene.V_t0.rows(), 128);
  scene.V_candidate.setZero();
  const CollisionStepResult result = scene.step();
  EXPECT_EQ(exact_defect(scene, result), "");
  EXPECT_EQ(result.report.cut_candidates, 128);
  EXPECT_LT(result.report.first_collisions, 1 << 14);

  const Mesh mesh = scene.mesh();
  CollisionStep step(mesh, scene.options);
  const CollisionStepResult abandoned =
      step(scene.V_t0, scene.V_candidate, scene.bodies(), scene.dt_s, Patience{.collisions = 1000});
  EXPECT_EQ(abandoned.report.status, StepStatus::kAbandoned);
  EXPECT_EQ(abandoned.report.first_collisions, (1 << 14) + 1);
  EXPECT_EQ(abandoned.x, scene.V_t0);
}

/// Every vertex of a sheet of 15 x 15 cells of a centimetre flies in a direction of its own: pairs of all parts of it
/// meet until the ways are about as long as an edge, far below 1024 diagonals of the scene.
TEST(CollisionStep, ASheetThatIsThrownInAllDirectionsIsCutBackUntilFewOfItsPairsMeet) {
  for (const bool on_ground : {false, true}) {  // a kilometre wide: the scene is no measure of the cloth
    StepScene scene;
    const auto cloth = scene.add(sheet(16, 0.15), Vec3::Zero());
    if (on_ground) scene.add(triangle(1000), Vec3(0, 0, -0.1), 0);
    std::mt19937_64 engine(1);
    std::normal_distribution<double> normal(0, on_ground ? 1e4 : 1e3);
    for (VertexId v = cloth.begin; v < cloth.end; ++v) {
      scene.V_candidate.row(v) += Eigen::RowVector3d(normal(engine), normal(engine), normal(engine));
    }
    SCOPED_TRACE(on_ground);
    const CollisionStepResult result = scene.step();
    EXPECT_EQ(exact_defect(scene, result), "");
    EXPECT_EQ(result.report.cut_candidates, cloth.end - cloth.begin);
    EXPECT_LE(result.report.first_collisions, 64 * scene.V_t0.rows());
  }
}

/// Nothing touches on the way to a billionth of the size, and in the end all 108,000 pairs are within the tolerance.
TEST(CollisionStep, AMeshThatShrinksToAPointIsCutBackBeforeAllPairsAreNear) {
  StepScene scene;
  scene.add(sheet(12), Vec3::Zero());
  scene.V_candidate = 1e-9 * scene.V_t0;
  const CollisionStepResult result = scene.step();
  EXPECT_EQ(exact_defect(scene, result), "");
  EXPECT_EQ(result.report.cut_candidates, 144);
  EXPECT_LE(result.report.first_collisions, 1 << 14);
}

/// Where it is the tolerance that is large, cloth moves whatever is near, as it was as near before.
TEST(CollisionStep, NothingIsCutBackForPairsThatAreNearInAnyCase) {
  StepScene scene;
  const auto cloth = scene.add(sheet(12), Vec3::Zero());
  scene.options.tolerance_m = 0.1;
  scene.push(cloth, Vec3(0, 0, 0.01));
  const CollisionStepResult result = scene.step();
  EXPECT_EQ(exact_defect(scene, result), "");
  EXPECT_EQ(result.report.cut_candidates, 0);
  EXPECT_GT(result.report.first_collisions, 1 << 14);
  EXPECT_GT(result.report.below_tolerance.size(), 1U << 14);
}

// 1024 diagonals of the box of all starts and of where scripts end.
TEST(TravelLimit, CutsWhatLeavesTheSceneByFarAndCountsIt) {
  StepScene scene;
  const auto body = scene.add(triangle(0.1), Vec3::Zero(), 0);
  const auto cloth = scene.add(triangle(0.1), Vec3(0, 0, 0.01));
  const auto cut = [&](const Vec3& of_body, double of_cloth_m) {
    scene.V_candidate = scene.V_t0;
    scene.push(body, of_body);
    scene.V_candidate(cloth.begin, 0) += of_cloth_m;
    StepMotion motion;
    motion.start(scene.V_t0, scene.V_candidate, Precision::kFloat64);
    const std::int64_t count = limit_travel(ScriptedGroups(scene.bodies()), motion);
    EXPECT_EQ(motion.displacement().topRows(3), (scene.V_candidate - scene.V_t0).topRows(3)) << "scripts are followed";
    return std::pair(count, motion.displacement().row(cloth.begin).norm());
  };
  const double diagonal_m = Vec3(0.2, 0.2, 0.01).norm();
  EXPECT_EQ(cut(Vec3::Zero(), 200), (std::pair<std::int64_t, double>(0, 200)));
  const auto [count, length_m] = cut(Vec3::Zero(), 300);
  EXPECT_EQ(count, 1);
  EXPECT_NEAR(length_m, kMaxTravel * diagonal_m, 1e-9);
  EXPECT_EQ(cut(Vec3(5, 0, 0), 300), (std::pair<std::int64_t, double>(0, 300))) << "the body goes far as well";
}

TEST(TravelLimit, HalvesTheWayOfClothAndNoScript) {
  StepScene scene;
  const auto body = scene.add(triangle(0.1), Vec3::Zero(), 0);
  const auto cloth = scene.add(triangle(0.1), Vec3(0, 0, 1));
  scene.push(body, Vec3(0, 0, 1));
  scene.V_candidate(cloth.begin, 2) += 8;
  StepMotion motion;
  motion.start(scene.V_t0, scene.V_candidate, Precision::kFloat64);
  EXPECT_EQ(halve_travel(ScriptedGroups(scene.bodies()), motion, 2), 1);
  scene.V_candidate(cloth.begin, 2) = scene.V_t0(cloth.begin, 2) + 2;
  EXPECT_EQ(motion.x(), scene.V_candidate);
}

}  // namespace selvage::sim::testbed
