// A host's floating-point environment stays out of a step, also where oneTBB hands it to tasks.
#include <cfenv>
#include <thread>

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include "tests/sim/step_scene.h"

namespace selvage::sim::testing {
namespace {

/// Two sheets on each other: parallel edges, whose nearest points are found by dividing by zero.
StepScene two_sheets() {
  StepScene scene;
  scene.add(make_sheet(20, 20, 0.2, 0.2), Vec3::Zero());
  const auto upper = scene.add(make_sheet(20, 20, 0.2, 0.2), Vec3(0, 0, 5e-4));
  scene.push(upper, Vec3(0, 0, -4e-4));
  return scene;
}

/// The result of its step on a thread of its own, in an arena whose tasks begin in the environment that `set` leaves.
template <typename Set>
CollisionStepResult step_in(const Set& set) {
  const StepScene scene = two_sheets();
  CollisionStepResult result;
  std::thread([&] {
    set();
    oneapi::tbb::task_arena arena(2);
    arena.execute([&] {
      oneapi::tbb::parallel_for(0, 4, [](int) {});
      result = scene.step();
    });
  }).join();
  return result;
}

TEST(HostEnvironment, ThatTrapsDivisionsOrRoundsUpwardsChangesNoBit) {
  const CollisionStepResult plain = step_in([] {});
  ASSERT_EQ(plain.report.status, StepStatus::kSafe);
  EXPECT_GT(plain.report.repulsions, 100);
  const CollisionStepResult trapping = step_in([] { feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW); });
  EXPECT_EQ(trapping.x, plain.x);
  const CollisionStepResult upwards = step_in([] { std::fesetround(FE_UPWARD); });
  EXPECT_EQ(upwards.x, plain.x);
}

}  // namespace
}  // namespace selvage::sim::testing
