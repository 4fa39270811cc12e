// A host's floating-point environment stays out of a step, also where oneTBB hands it to tasks.
#include "tests/host_environment.h"

#include <cfenv>

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

/// The result of its step.
template <typename Set>
CollisionStepResult step_in(const Set& set) {
  const StepScene scene = two_sheets();
  CollisionStepResult result;
  selvage::testing::in_host_environment(set, [&] { result = scene.step(); });
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
