// A host may step from within tasks of its own: where it cancels these, a step is as safe as it is otherwise.
#include "tests/host_tasks.h"

#include "sim/scene/scene_reader.h"
#include "sim/step.h"
#include "sim/subdivision/subdivision.h"
#include "tests/sim/small_scene.h"
#include "tests/sim/step_scene.h"

namespace selvage::sim::testbed {

TEST(HostTasks, ThatAreCancelledChangeNoStep) {
  StepScene scene;
  scene.add(make_sheet(40, 40, 0.4, 0.4), Vec3::Zero());
  const auto upper = scene.add(make_sheet(40, 40, 0.4, 0.4), Vec3(1e-3, 2e-3, 5e-3));
  scene.push(upper, Vec3(0, 0, -0.02));
  const auto step = [&] { return scene.step(); };
  const CollisionStepResult expected = step(), found = selvage::testing::in_cancelled_task(step);
  ASSERT_EQ(expected.report.status, StepStatus::kSafe);
  EXPECT_EQ(found.report.status, StepStatus::kSafe);
  EXPECT_EQ(found.x, expected.x);
}

TEST(HostTasks, ThatAreCancelledChangeNoSimulation) {
  for (const std::string solver : {"explicit", "implicit"}) {
    const auto simulated = [&] {
      Simulation simulation(
          parse_scene(selvage::testing::small_scene_text(40, "solver = \"" + solver + "\"\n"), "tasks.toml"));
      for (int n = 0; n < 3; ++n) (void)simulation.step();
      return simulation.x();
    };
    EXPECT_EQ(selvage::testing::in_cancelled_task(simulated), simulated()) << solver;
  }
}

TEST(HostTasks, ThatAreCancelledChangeNoSubdivision) {
  const Shape shape = make_sheet(30, 30, 1, 1);
  const auto subdivided = [&] {
    SubdivisionCounts counts;
    return Subdivision(shape.triangles, static_cast<std::int32_t>(shape.x.rows()), {}, 2)(shape.x, counts);
  };
  EXPECT_EQ(selvage::testing::in_cancelled_task(subdivided), subdivided());
}

}  // namespace selvage::sim::testbed
