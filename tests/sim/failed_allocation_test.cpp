// Memory may end anywhere in a step: the exception leaves nothing behind that another step from there would use.
#include <new>

#include <oneapi/tbb/global_control.h>

#include "tests/sim/failing_allocations.h"
#include "tests/sim/step_scene.h"

namespace selvage::sim::testbed {
namespace {

TEST(FailedAllocation, LeavesAStepThatAnswersAsANewOne) {
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  StepScene scene;
  scene.add(make_sheet(8, 8, 0.1, 0.1), Vec3::Zero());
  const auto upper = scene.add(make_sheet(8, 8, 0.1, 0.1), Vec3(1e-3, 2e-3, 5e-4));
  Positions apart = scene.V_t0;  // where the step that fails comes from
  apart.bottomRows(64).col(2).array() += 0.5;
  scene.push(upper, Vec3(0, 0, -4e-4));
  const Mesh mesh = scene.mesh();
  const CollisionStepResult expected =
      CollisionStep(mesh, scene.options)(scene.V_t0, scene.V_candidate, scene.bodies(), scene.dt_s);
  ASSERT_GT(expected.report.repulsions, 20);
  for (const bool is_first : {true, false}) {  // step of its object
    int failures = 0;
    for (bool has_failed = true; has_failed;) {
      CollisionStep step(mesh, scene.options);
      if (!is_first) {
        ASSERT_EQ(step(apart, apart, scene.bodies(), scene.dt_s).report.status, StepStatus::kSafe);
      }
      has_failed = false;
      fail_allocation(failures);
      try {
        static_cast<void>(step(scene.V_t0, scene.V_candidate, scene.bodies(), scene.dt_s));
      } catch (const std::bad_alloc&) {
        has_failed = true;
      }
      fail_allocation(kNone);
      failures += has_failed ? 1 : 0;
      const CollisionStepResult again = step(scene.V_t0, scene.V_candidate, scene.bodies(), scene.dt_s);
      ASSERT_EQ(again.x, expected.x) << "after allocation " << failures;
      ASSERT_EQ(again.report.repulsions, expected.report.repulsions) << "after allocation " << failures;
    }
    EXPECT_GT(failures, 100);
  }
}

}  // namespace
}  // namespace selvage::sim::testbed
