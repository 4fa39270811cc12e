// Where bodies leave cloth no room (S4): they stop the run, or wait.
#include <algorithm>
#include <limits>

#include <gtest/gtest.h>

#include "sim/bodies/catch_up.h"
#include "sim/record/run_totals.h"
#include "sim/response/scripted_groups.h"
#include "sim/scene/scene_reader.h"
#include "sim/step.h"
#include "tests/sim/exact_step.h"
#include "tests/sim/foot_scene.h"
#include "tests/squeeze_scene.h"

namespace selvage {

using namespace sim;
using testing::violations;

namespace {

Scene squeeze_scene(const std::string& policy) {
  return parse_scene(testing::squeeze_scene_text(policy), "squeeze.toml");
}

}  // namespace

TEST(Squeeze, StopsWithAWitnessWhereBodiesSqueeze) {
  Simulation simulation(squeeze_scene("stop"));
  StepResult step;
  Positions before;
  do {
    before = simulation.x();
    step = simulation.step();
  } while (step.report.status == StepStatus::kSafe && simulation.clock().frame() < 10);
  ASSERT_EQ(step.report.status, StepStatus::kStopped);
  EXPECT_TRUE(step.report.witness.has_value());
  EXPECT_EQ(simulation.x(), before) << "nothing is advanced";
}

TEST(Squeeze, BodiesWaitUnderYieldAndTheClothStaysFree) {
  Simulation simulation(squeeze_scene("yield"));
  RunTotals totals;
  EXPECT_EQ(totals.shortfalls(), "");
  while (simulation.clock().frame() < 10) {
    const Positions before = simulation.x();
    const StepResult step = simulation.step();
    ASSERT_EQ(step.report.status, StepStatus::kSafe);
    ASSERT_EQ(violations(simulation.world(), before, simulation.x()), 0);
    ASSERT_TRUE(step.report.without_room.empty() || simulation.state().loads.empty());
    ASSERT_TRUE(step.report.without_room.empty() || !step.report.waiting_bodies.empty());
    totals.add(step);
  }
  EXPECT_GT(totals.waiting_bodies, 0);
  EXPECT_NE(totals.shortfalls().find("times a body waited"), std::string::npos);
}

namespace {

// A ball is pressed 2 cm too deep into cloth on the ground for a second, and drawn aside.
constexpr const char* kPressed = R"(
squeeze = "yield"
gravity_m_s2 = [0, 0, -9.81]
[time]
frames_per_s = 30
frames = 70
[collision]
thickness_m = 0.004
friction_static = 0.3
[[cloth]]
sheet = {nx = 14, ny = 14, width_m = 0.5, height_m = 0.5}
position_m = [0, 0, 0.01]
density_kg_m2 = 0.2
stretch_n_m = 60
shear_n_m = 20
bend_n_m = 0.6
damping_ratio = 0.1
[[body]]
name = "ball"
sphere = {radius_m = 0.15, subdivisions = 2}
position_m = [0, 0, 0.25]
interpolation = "linear"
key = [{time_s = 0}, {time_s = 0.4, position_m = [0, 0, -0.12]}, {time_s = 1.4, position_m = [0, 0, -0.12]},
       {time_s = 2, position_m = [0.3, 0, 0.1]}]
[[body]]
name = "ground"
sheet = {nx = 2, ny = 2, width_m = 20, height_m = 20}
)";

}  // namespace

// Loads of all contacts were forgotten for it: six sheets that lay ten metres away sank by an eighth, and trembled.
TEST(Squeeze, ABodyThatWaitsIsNotFeltByWhatRestsElsewhere) {
  const std::string far = R"(
[[cloth]]
name = "far"
copies = 3
copy_offset_m = [0.01, 0.01, 0.0041]
sheet = {nx = 5, ny = 5, width_m = 0.2, height_m = 0.2}
position_m = [5, 0, 0.0041]
density_kg_m2 = 0.2
stretch_n_m = 60
)";
  Simulation simulation(parse_scene(kPressed + far, "pressed.toml"));
  const VertexId first = 14 * 14, end = first + 3 * 25;
  std::int64_t waits = 0, without_room = 0;
  double fastest_m_s = 0;
  while (simulation.clock().frame() < 40) {
    const Positions before = simulation.x();
    const StepResult step = simulation.step();
    ASSERT_EQ(step.report.status, StepStatus::kSafe);
    if (step.report.waiting_bodies.empty()) continue;
    ++waits;
    const Positions way = (simulation.x() - before).middleRows(first, end - first);
    fastest_m_s = std::max(fastest_m_s, way.rowwise().norm().maxCoeff() / step.dt_s);
    const auto is_far = [&](const ContactLoad& load) { return load.first >= first && load.first < end; };
    ASSERT_TRUE(std::ranges::any_of(simulation.state().loads.vf, is_far));
    if (step.report.without_room.empty()) continue;  // it keeps off for a while
    ++without_room;
    ASSERT_TRUE(std::ranges::all_of(simulation.state().loads.vf, is_far)) << "what is pressed had no room";
  }
  EXPECT_GT(waits, 20);
  EXPECT_GT(without_room, 5);
  EXPECT_GT(simulation.x().middleRows(first, end - first).col(2).minCoeff(), 0.00395);
  EXPECT_GT(simulation.x().middleRows(end - 25, 25).col(2).minCoeff(), 0.0118);
  EXPECT_LT(fastest_m_s, 2e-3);
}

TEST(Squeeze, WhatWaitsStandsStillForTheClothAndComesBackSlowly) {
  Simulation simulation(parse_scene(kPressed, "pressed.toml"));
  const std::int32_t cloth = simulation.world().cloth_vertex_count;
  const Collider& ball = simulation.world().colliders.front();
  double fastest_m_s = 0, fastest_ball_m_s = 0, pressed_m_s = 0;
  std::int64_t waits = 0, steps = 0;
  while (simulation.clock().frame() < 70) {
    const Positions before = simulation.x();
    const StepResult step = simulation.step();
    ASSERT_EQ(step.report.status, StepStatus::kSafe);
    const auto speed_m_s = ((simulation.x() - before) / step.dt_s).rowwise().norm().eval();
    fastest_m_s = std::max(fastest_m_s, speed_m_s.head(cloth).maxCoeff());
    for (const VertexId v : ball.vertices()) fastest_ball_m_s = std::max(fastest_ball_m_s, speed_m_s[v]);
    if (simulation.clock().frame() == 40) pressed_m_s = speed_m_s.head(cloth).maxCoeff();
    waits += static_cast<std::int64_t>(step.report.waiting_bodies.size());
    ++steps;
  }
  EXPECT_GT(waits, 20);
  EXPECT_LT(pressed_m_s, 0.03) << "it rests under the ball; 0.4 m/s where the dynamics saw the ball move";
  EXPECT_LT(fastest_ball_m_s, 1.6) << "its script goes at 0.9 m/s";
  EXPECT_LT(fastest_m_s, 5);
  EXPECT_LT(steps, 300);
  const Positions end = ball.placed_at(simulation.clock().time_s(), sim::Precision::kFloat64, simulation.x());
  EXPECT_EQ(Positions(simulation.x()(ball.vertices(), Eigen::all)), end) << "to the bit";
}

TEST(Squeeze, AFastBodyFarAwayMakesNoStepShorter) {
  const std::string fan =
      "[[body]]\nname = \"fan\"\nbox = {size_m = [2, 0.02, 0.1]}\nposition_m = [30, 0, 1]\ninterpolation = \"linear\"\n"
      "key = [{time_s = 0}, {time_s = 1, rotation_deg = [0, 0, 14400]}]\n";
  const auto steps = [](const std::string& scene) {
    Simulation simulation(parse_scene(scene, "pressed.toml"));
    std::int64_t count = 0;
    for (; simulation.clock().frame() < 15; ++count) simulation.step();
    return count;
  };
  EXPECT_EQ(steps(kPressed + fan), steps(kPressed));
}

TEST(Squeeze, WhatHasWaitedFarFromItsScriptDoesNotJump) {
  // Pressed 0.3 m too deep, until the ground gives way.
  std::string text = kPressed;
  const std::size_t keys = text.find("{time_s = 0.4"), end = text.find("]\n[[body]]\nname = \"ground\"");
  text.replace(keys, end - keys, "{time_s = 1, position_m = [0, 0, -0.4]}");
  text += "interpolation = \"linear\"\nkey = [{time_s = 1.2}, {time_s = 1.3, position_m = [0, 0, -0.5]}]\n";
  Simulation simulation(parse_scene(text, "trapdoor.toml"));
  const Collider& ball = simulation.world().colliders.front();
  double fastest_m_s = 0, farthest_behind_m = 0;
  while (simulation.clock().frame() < 70) {
    const Positions before = simulation.x()(ball.vertices(), Eigen::all);
    const StepResult step = simulation.step();
    ASSERT_EQ(step.report.status, StepStatus::kSafe);
    const Positions now = simulation.x()(ball.vertices(), Eigen::all);
    fastest_m_s = std::max(fastest_m_s, (now - before).row(0).norm() / step.dt_s);
    const Positions script = ball.placed_at(simulation.clock().time_s(), sim::Precision::kFloat64, simulation.x());
    farthest_behind_m = std::max(farthest_behind_m, (script - now).row(0).norm());
  }
  EXPECT_GT(farthest_behind_m, 0.1);
  EXPECT_LT(fastest_m_s, 1.1 * (farthest_behind_m / kCatchUpTime_s + 0.6)) << "its script goes at 0.5 m/s";
  EXPECT_EQ(Positions(simulation.x()(ball.vertices(), Eigen::all)),
            ball.placed_at(simulation.clock().time_s(), sim::Precision::kFloat64, simulation.x()));
}

namespace {

/// It slides on by 0.3 m, and is lifted.
Scene foot_scene() {
  const std::string foot = R"(sphere = {radius_m = 0.03, subdivisions = 2}
position_m = [0.1, 0, 0.06]
interpolation = "linear"
key = [{time_s = 0}, {time_s = 0.2, position_m = [0, 0, -0.0335]}, {time_s = 0.3, position_m = [0, 0, -0.0335]},
       {time_s = 0.7, position_m = [0.3, 0, -0.0335]}, {time_s = 0.8, position_m = [0.3, 0, 0.1]}])";
  return parse_scene(testbed::foot_scene_text(foot), "foot.toml");
}

}  // namespace

// It stood still where it was pressed, and leapt after its script when it was lifted, with the cloth.
TEST(Squeeze, ABodyGoesOnAlongWhatBlocksIt) {
  Simulation simulation(foot_scene());
  const Collider& foot = simulation.world().colliders.front();
  const std::int32_t cloth = simulation.world().cloth_vertex_count;
  double farthest_behind_m = 0, fastest_m_s = 0;
  std::int64_t waits = 0;
  while (simulation.clock().frame() < 24) {
    const Positions before = simulation.x();
    const StepResult step = simulation.step();
    ASSERT_EQ(step.report.status, StepStatus::kSafe);
    ASSERT_EQ(violations(simulation.world(), before, simulation.x()), 0);
    EXPECT_EQ(step.report.fail_safe_vertices, 0);
    farthest_behind_m = std::max(farthest_behind_m, testbed::behind_script_m(simulation, foot));
    const bool waits_now = !step.report.waiting_bodies.empty();
    EXPECT_EQ(step.report.waiting_vertices, waits_now ? foot.vertices() : std::vector<VertexId>{});
    waits += std::ssize(step.report.waiting_bodies);
    const Positions way = (simulation.x() - before).topRows(cloth);
    fastest_m_s = std::max(fastest_m_s, way.rowwise().norm().maxCoeff() / step.dt_s);
  }
  EXPECT_GT(waits, 10);
  EXPECT_LT(farthest_behind_m, 0.012) << "0.28 where it stood still; it keeps off by 2 mm";
  EXPECT_LT(fastest_m_s, 5) << "its script goes at 0.75 m/s, and at 1.3 m/s when it is lifted";
  EXPECT_EQ(testbed::behind_script_m(simulation, foot), 0);
}

TEST(Squeeze, WhatBlocksABodyIsPartOfTheState) {
  const Scene scene = foot_scene();
  Simulation through(scene);
  while (through.state().blocked.empty()) {
    ASSERT_LT(through.clock().frame(), 24);
    ASSERT_EQ(through.step().report.status, StepStatus::kSafe);
  }
  Simulation resumed(scene);
  resumed.restore(through.state());
  for (int i = 0; i < 5; ++i) {
    ASSERT_EQ(through.step().report.status, StepStatus::kSafe);
    ASSERT_EQ(resumed.step().report.status, StepStatus::kSafe);
    ASSERT_EQ(resumed.x(), through.x()) << i;
    ASSERT_EQ(resumed.state().blocked, through.state().blocked) << i;
  }
}

TEST(Squeeze, ABodyOfTheLargestNumberIsNoPin) {
  constexpr std::int32_t kLast = std::numeric_limits<std::int32_t>::max();
  const std::vector<double> inverse_mass{0, 0, 1, 0};
  const std::vector<std::int32_t> body{kLast, -1, -1, 7};
  const ScriptedGroups groups({inverse_mass, body});
  ASSERT_EQ(groups.count(), 3);
  EXPECT_EQ(groups.body(groups.group(0)), kLast);
  EXPECT_EQ(groups.body(groups.group(1)), -1);
  EXPECT_EQ(groups.body(groups.group(3)), 7);
  EXPECT_EQ(groups.group(1), 2) << "the pins are after every body";
}

}  // namespace selvage
