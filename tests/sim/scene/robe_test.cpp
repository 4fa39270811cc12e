// The scene of the robe: a figure of many parts and a garment that it wears, in short.
#include <gtest/gtest.h>

#include "sim/base/points.h"
#include "sim/scene/scene_reader.h"
#include "sim/step.h"
#include "verify/check.h"

namespace selvage {

using namespace sim;

namespace {

Scene coarse_robe() {
  Scene scene = read_scene(std::string(SELVAGE_SOURCE_DIR) + "/sim/scenes/robe.toml");
  std::get<GarmentSpec>(scene.cloths.at(0).surface).cell_m = 0.08;
  return scene;
}

}  // namespace

TEST(Robe, EveryStepIsExactlyFreeAlthoughThePartsOfTheFigureIntersect) {
  Simulation simulation(coarse_robe());
  const World& world = simulation.world();
  const std::vector<std::uint8_t> is_body = io::body_faces(world.triangles.size(), world.groups);
  const verify::Topology topology =
      verify::make_topology({world.triangles, is_body}, std::size_t(simulation.x().rows()));
  verify::CheckOptions with_bodies;
  with_bodies.check_bodies = true;
  EXPECT_GT(verify::check_frame(topology, points_of(simulation.x()), with_bodies).violations_total.total(), 1000);
  ASSERT_EQ(verify::check_frame(topology, points_of(simulation.x()), {}).violations_total.total(), 0);
  std::int64_t repulsions = 0, fail_safe_vertices = 0;
  while (simulation.clock().frame() < 8) {
    const std::vector<verify::Point> before = points_of(simulation.x());
    const StepResult step = simulation.step();
    ASSERT_EQ(step.report.status, StepStatus::kSafe);
    const std::vector<verify::Point> after = points_of(simulation.x());
    ASSERT_EQ(verify::check_motion(topology, before, after, {}).violations_total.total(), 0);
    repulsions += step.report.repulsions;
    fail_safe_vertices += step.report.fail_safe_vertices;
  }
  EXPECT_GT(repulsions, 1000) << "the shoulders carry the robe";
  EXPECT_EQ(fail_safe_vertices, 0);
}

}  // namespace selvage
