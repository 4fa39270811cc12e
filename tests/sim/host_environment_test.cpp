// A host's floating-point environment stays out of a step, also where oneTBB hands it to tasks.
#include "tests/host_environment.h"

#include <cfenv>
#include <fstream>

#include "sim/contact/contact_table.h"
#include "sim/contact/rest_pairs.h"
#include "sim/scene/scene_reader.h"
#include "sim/step.h"
#include "sim/subdivision/subdivision.h"
#include "tests/fp_control.h"
#include "tests/sim/small_scene.h"
#include "tests/sim/step_scene.h"

namespace selvage::sim::testbed {
namespace {

using selvage::testing::fp_control;
using selvage::testing::kFlushing;
using selvage::testing::set_fp_control;

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

/// Positions after some frames of a simulation that a host reads, builds and steps.
template <typename Set>
Positions simulated_in(const Set& set, const std::string& solver) {
  const selvage::testing::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "scene.toml";
  std::ofstream(file) << selvage::testing::small_scene_text(8, "solver = \"" + solver + "\"\n")
                      << "rotation_deg = [31, 17, 5]\n";
  Positions x;
  selvage::testing::in_host_environment(set, [&] {
    Simulation simulation(read_scene(file));
    for (int n = 0; n < 20; ++n) EXPECT_EQ(simulation.step().report.status, StepStatus::kSafe);
    x = simulation.x();
  });
  return x;
}

TEST(HostEnvironment, DoesNotChangeASimulation) {
  for (const std::string solver : {"explicit", "implicit"}) {
    const Positions plain = simulated_in([] {}, solver);
    EXPECT_EQ(simulated_in([] { feenableexcept(FE_DIVBYZERO | FE_INVALID | FE_OVERFLOW); }, solver), plain) << solver;
    EXPECT_EQ(simulated_in([] { std::fesetround(FE_UPWARD); }, solver), plain) << solver;
    EXPECT_EQ(simulated_in([] { set_fp_control(fp_control() | kFlushing); }, solver), plain) << solver;
  }
}

TEST(HostEnvironment, DoesNotChangeASubdivision) {
  const Shape ball = make_sphere(0.3, 1);
  const auto fine_in = [&](const auto& set) {
    Positions x;
    selvage::testing::in_host_environment(set, [&] {
      const Subdivision subdivision(ball.triangles, static_cast<std::int32_t>(ball.x.rows()), {}, 2);
      SubdivisionCounts counts;
      x = subdivision(ball.x, counts);
    });
    return x;
  };
  EXPECT_EQ(fine_in([] { std::fesetround(FE_UPWARD); }), fine_in([] {}));
}

/// What a step is made of is found in a constructor, and by find_rest_pairs(): lengths of 1e-310 m are subnormal.
TEST(HostEnvironment, ThatFlushesSubnormalsLosesNoThickness) {
  StepScene scene;
  scene.add(make_sheet(8, 8, 1e-310, 1e-310), Vec3::Zero());
  const Mesh mesh = scene.mesh();
  ContactSurfaces surfaces;
  surfaces.properties = {{.thickness_m = 2e-311, .tolerance_m = 1e-312}};
  surfaces.surface_of_vertex.assign(64, 0);
  std::vector<RestPair> pairs;
  double thickness = 0, tolerance = 0;
  const auto look = [&] {
    pairs = find_rest_pairs(mesh, scene.V_t0, 2e-311);
    surfaces.rest_pairs = pairs;
    const CollisionStep step(mesh, {}, surfaces);
    const ContactTable& table = step.contact_table();
    thickness = table.thickness_upper();
    tolerance = table.tolerance_upper();
  };
  selvage::testing::in_host_environment([] {}, look);
  const std::vector<RestPair> plain = pairs;
  ASSERT_GT(plain.size(), 100U);
  selvage::testing::in_host_environment([] { set_fp_control(fp_control() | kFlushing); }, look);
  EXPECT_TRUE(pairs == plain) << pairs.size();
  EXPECT_EQ(thickness, 2e-311);
  EXPECT_EQ(tolerance, 1e-312);
}

}  // namespace
}  // namespace selvage::sim::testbed
