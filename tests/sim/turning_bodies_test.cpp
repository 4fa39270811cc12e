// Bodies that do not go straight in a step: they meet what is beside their straight way, and cloth that sticks to them
// stays where it is.
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "sim/record/run_totals.h"
#include "sim/scene/rigid_path.h"
#include "sim/scene/scene_reader.h"
#include "sim/step.h"
#include "tests/temporary_folder.h"

namespace selvage::sim {
namespace {

constexpr const char* kMaterial = "density_kg_m2 = 0.2\nstretch_n_m = 200\nshear_n_m = 20\n";

/// `time` is in the table of that name, `more` before it.
Simulation make(const std::string& solver, const std::string& time, const std::string& more) {
  return Simulation(parse_scene("solver = \"" + solver + "\"\n" + more + "[time]\n" + time + "\n", "turning.toml"));
}

/// Of one step: whether anything met.
bool meets(const StepResult& step) {
  return step.report.status == StepStatus::kStopped || step.report.repulsions > 0 || step.report.first_collisions > 0;
}

// The blade is back where it was at the end of every frame.
TEST(TurningBodies, ABladeThatTurnsOnceAFrameMeetsTheCloth) {
  for (const char* solver : {"explicit", "implicit"}) {
    Simulation simulation =
        make(solver, "duration_s = 0.1",
             "[collision]\nthickness_m = 0.004\n[[cloth]]\nsheet = {nx = 10, ny = 10, width_m = 0.4, "
             "height_m = 0.4}\nposition_m = [0, 0.6, 0]\nrotation_deg = [0, 90, 0]\n" +
                 std::string(kMaterial) +
                 "[[cloth.pin]]\nedge = \"top\"\n[[body]]\nbox = {size_m = [2, 0.05, 0.3]}\n"
                 "key = [{time_s = 0}, {time_s = 1, rotation_deg = [0, 0, 10800]}]\n");
    bool has_met = false;
    while (!has_met && simulation.clock().time_s() < 0.1 - 1e-9) has_met = meets(simulation.step());
    EXPECT_TRUE(has_met) << solver;
    EXPECT_LT(simulation.clock().time_s(), 0.02) << solver << ": it is there after a quarter of a turn";
  }
}

// Where the cloth is when the step begins the blade does not come.
TEST(TurningBodies, ABladeMeetsTheClothThatFliesIntoItsWay) {
  const auto first_step_s = [](const std::string& velocity_m_s) {
    return make("explicit", "frames = 1",
                "[collision]\nthickness_m = 0.004\n[[cloth]]\nsheet = {nx = 4, ny = 4, width_m = 0.1, height_m = "
                "0.1}\nposition_m = [5, 0, 0]\nvelocity_m_s = " +
                    velocity_m_s + "\n" + kMaterial +
                    "[[body]]\nbox = {size_m = [2, 0.05, 0.3]}\n"
                    "key = [{time_s = 0}, {time_s = 1, rotation_deg = [0, 0, 10800]}]\n")
        .step()
        .dt_s;
  };
  EXPECT_LT(first_step_s("[-60, 0, 0]"), 0.02)
      << "in a frame it comes to 3 m, and the blade's box for a turn reaches to 3.8";
  EXPECT_GT(first_step_s("[60, 0, 0]"), 0.03);
}

// The thickness of their contacts counts, whatever that of the scene is.
TEST(TurningBodies, KeepToTheirWayWithinTheThicknessOfTheirOwnContacts) {
  const auto first_step_s = [](const std::string& scene_m, const std::string& own) {
    return make("explicit", "frames = 1",
                "[collision]\nthickness_m = " + scene_m +
                    "\n[[cloth]]\nsheet = {nx = 4, ny = 4, width_m = 0.1, height_m = 0.1}\n"
                    "position_m = [0.5, 0, 0.1508]\n" +
                    own + kMaterial + "[[body]]\nbox = {size_m = [2, 0.05, 0.3]}\n" + own +
                    "key = [{time_s = 0}, {time_s = 1, rotation_deg = [0, 0, 900]}]\n")
        .step()
        .dt_s;
  };
  const double thin_s = first_step_s("0.001", ""), thick_s = first_step_s("0.016", "");
  EXPECT_LT(3 * thin_s, thick_s);
  EXPECT_EQ(first_step_s("0.016", "thickness_m = 0.001\n"), thin_s);
  EXPECT_EQ(first_step_s("0.001", "thickness_m = 0.016\n"), thick_s);
}

// One far away, as exporters write them for "none", goes far with every turn, where no surface is.
TEST(TurningBodies, AVertexThatNoFaceHoldsShortensNoStep) {
  const testing::TemporaryFolder folder;
  const auto step_beside = [&](const std::string& stray_vertices) {
    testing::spit(folder / "rod.obj", stray_vertices +
                                          "v 0 0.03 0\nv 0 -0.03 0\nv 1 0 0\nv 0 0 0.02\n"
                                          "f -4 -3 -2\nf -4 -1 -3\nf -3 -1 -2\nf -2 -1 -4\n");
    Simulation simulation(
        parse_scene("[time]\nframes = 1\n[collision]\nthickness_m = 0.004\n[[cloth]]\n"
                    "sheet = {nx = 4, ny = 4, width_m = 0.1, height_m = 0.1}\nposition_m = [0.5, 0, 0.03]\n" +
                        std::string(kMaterial) +
                        "[[body]]\nmesh = {file = \"rod.obj\"}\n"
                        "key = [{time_s = 0}, {time_s = 1, rotation_deg = [0, 0, 600]}]\n",
                    folder / "scene.toml"));
    const Eigen::AlignedBox3d within = simulation.world().colliders.front().bend(0, 0.1).within;
    EXPECT_LT(within.max().cwiseAbs().maxCoeff(), 1.5) << stray_vertices;
    EXPECT_LT(within.min().cwiseAbs().maxCoeff(), 1.5) << stray_vertices;
    return simulation.step();
  };
  const StepResult alone = step_beside("");
  EXPECT_LT(alone.dt_s, 0.03) << "the rod itself turns too far in a frame";
  for (const char* strays : {"v 20 0 0\n", "v 900000000 0 0\n", "v -20 3 1\nv 0 900000000 0\n"}) {
    const StepResult step = step_beside(strays);
    EXPECT_EQ(step.dt_s, alone.dt_s) << strays;
    EXPECT_FALSE(step.is_bent) << strays;
  }
}

// A pin holds vertices, whatever faces do.
TEST(TurningBodies, APinThatTurnsShortensSteps) {
  const Simulation simulation =
      make("explicit", "frames = 1",
           "[[cloth]]\nsheet = {nx = 4, ny = 4, width_m = 0.2, height_m = 0.2}\n" + std::string(kMaterial) +
               "[[cloth.pin]]\nedge = \"top\"\n"
               "key = [{time_s = 0}, {time_s = 1, rotation_deg = [0, 0, 60]}]\n");
  const Collider& pin = simulation.world().colliders.front();
  EXPECT_NEAR(pin.bend(0, 1).leaves_line_by_m, 0.1 * (1 - std::sqrt(0.75)), 1e-12);
}

// A figure that steps aside by 0.1 m and back within two frames; what hangs on it is seen where it is placed for
// itself.
TEST(TurningBodies, WhatASequenceCarriesIsSeenWithIt) {
  const testing::TemporaryFolder folder;
  for (const int frame : {0, 1, 2}) {
    const std::string y = frame == 1 ? "0.1" : "0";
    testing::spit(folder / ("figure_" + std::to_string(frame) + ".obj"),
                  "v 0 " + y + " 0\nv 1 " + y + " 0\nv 0 " + y + " 1\nf 1 2 3\n");
  }
  const Simulation simulation(parse_scene(
      "[time]\nframes = 1\n[collision]\nthickness_m = 0.004\n[[cloth]]\nsheet = {nx = 4, ny = 4, width_m = 0.2, "
      "height_m = 0.2}\nposition_m = [0.5, 0.02, 0.2]\n" +
          std::string(kMaterial) +
          "[[cloth.pin]]\nedge = \"top\"\nbody = \"figure\"\n[[cloth.pin]]\nedge = \"bottom\"\nbody = \"figure\"\n"
          "[[body]]\nname = \"figure\"\nsequence = {file = \"figure_*.obj\", frames_per_s = 30}\n",
      folder / "scene.toml"));
  const std::vector<Collider>& colliders = simulation.world().colliders;
  ASSERT_EQ(colliders.size(), 3U);
  const Collider* const pins[] = {&colliders[1], &colliders[2]};
  EXPECT_EQ(pins[0]->carrier(), std::optional<std::size_t>(0));
  const std::vector<Collider::Bend> bends = colliders[0].bends(0, 2.0 / 30, pins);
  ASSERT_EQ(bends.size(), 3U);
  for (const Collider::Bend& bend : bends) EXPECT_NEAR(bend.leaves_line_by_m, 0.1, 1e-12);
  EXPECT_EQ(bends[0].within.min(), colliders[0].bend(0, 2.0 / 30).within.min());
  EXPECT_NEAR(bends[1].within.max()[1], 0.12 + 0.1 + 0.1, 1e-12) << "once more beyond where it was seen";
  EXPECT_NEAR(bends[2].within.max()[1], -0.08 + 0.1 + 0.1, 1e-12);
}

// On a spindle that turns by 80 degrees a frame; the chord of its way passes within the post.
TEST(TurningBodies, ClothThatABodyCarriesMeetsWhatStandsInItsWay) {
  Simulation simulation =
      make("explicit", "frames = 2",
           "[collision]\nthickness_m = 0.004\n[[cloth]]\nsheet = {nx = 3, ny = 3, width_m = 0.04, height_m = 0.04}\n"
           "position_m = [0.95, 0, 0]\n" +
               std::string(kMaterial) +
               "[[cloth.pin]]\nvertices = [0, 1, 2, 3, 4, 5, 6, 7, 8]\nbody = \"spindle\"\n"
               "[[body]]\nname = \"spindle\"\nbox = {size_m = [0.01, 0.01, 0.4]}\n"
               "key = [{time_s = 0}, {time_s = 1, rotation_deg = [0, 0, 2400]}]\n"
               "[[body]]\nname = \"post\"\nbox = {size_m = [0.02, 0.02, 0.4]}\nposition_m = [0.727, 0.61, 0]\n");
  StepResult step = simulation.step();
  EXPECT_LT(step.dt_s, 0.01) << "an arc of 4 mm";
  while (step.report.status != StepStatus::kStopped && simulation.clock().time_s() < 1.0 / 30 - 1e-9)
    step = simulation.step();
  EXPECT_EQ(step.report.status, StepStatus::kStopped) << "what is pinned cannot give way";
}

TEST(TurningBodies, ABoxThatComesAndGoesWithinAStepThrowsTheCloth) {
  Simulation simulation =
      make("explicit", "duration_s = 0.2",
           "[collision]\nthickness_m = 0.004\n[[cloth]]\nsheet = {nx = 6, ny = 6, width_m = 0.1, "
           "height_m = 0.1}\n" +
               std::string(kMaterial) +
               "[[body]]\nbox = {size_m = [0.4, 0.4, 0.1]}\nkey = [{time_s = 0, position_m = [0, 0, -0.1]}, "
               "{time_s = 0.013, position_m = [0, 0, 0.3]}, {time_s = 0.031, position_m = [0, 0, -0.1]}]\n");
  while (simulation.clock().time_s() < 0.1 - 1e-9) simulation.step();
  EXPECT_GT(simulation.x().topRows(36).col(2).minCoeff(), 0.3);
}

// It goes round 25 times through the place of the sheet, and is where it began at quarters of every frame.
TEST(TurningBodies, ABallThatGoesRoundFourTimesAFrameMeetsTheCloth) {
  Simulation simulation =
      make("explicit", "frames_per_s = 12.5\nframes = 1",
           "squeeze = \"yield\"\n[collision]\nthickness_m = 0.004\n[[cloth]]\nsheet = {nx = 6, ny = 6, width_m = 0.3, "
           "height_m = 0.3}\nposition_m = [-0.5, 0, 0]\nrotation_deg = [90, 0, 0]\n" +
               std::string(kMaterial) +
               "[[body]]\nname = \"hub\"\nbox = {size_m = [0.01, 0.01, 0.01], cells = 1}\n"
               "key = [{time_s = 0}, {time_s = 1, rotation_deg = [0, 0, 18000]}]\n"
               "[[body]]\nname = \"ball\"\nparent = \"hub\"\nsphere = {radius_m = 0.05, subdivisions = 1}\n"
               "position_m = [0.5, 0, 0]\n");
  bool has_met = false;
  while (!has_met && simulation.clock().frame() < 1) has_met = meets(simulation.step());
  EXPECT_TRUE(has_met);
}

/// How fast a sheet that lay on a box leaves it, m/s: the box goes up by 0.1 m from `start_s` to `end_s`.
double thrown_m_s(double start_s, double end_s) {
  Simulation simulation = make(
      "explicit", "frames_per_s = 30\nframes = 6",
      "[collision]\nthickness_m = 0.004\n[[cloth]]\nsheet = {nx = 6, ny = 6, width_m = 0.3, height_m = 0.3}\n"
      "position_m = [0, 0, 0.004]\n" +
          std::string(kMaterial) +
          "[[body]]\nbox = {size_m = [0.6, 0.6, 0.05], cells = 3}\nkey = [{time_s = " + std::to_string(start_s) +
          ", position_m = [0, 0, -0.025]}, {time_s = " + std::to_string(end_s) + ", position_m = [0, 0, 0.075]}]\n");
  while (simulation.clock().frame() < 6) simulation.step();
  return simulation.state().v.topRows(36).col(2).mean();
}

// Wherever in a frame that is.
TEST(TurningBodies, ABoxThatStartsWithinAStepThrowsClothAtItsOwnSpeed) {
  for (const double start_s : {0.0, 0.004, 0.01, 0.016667, 0.0225, 0.03}) {
    EXPECT_NEAR(thrown_m_s(start_s, start_s + 0.05), 2, 0.01) << start_s;
    EXPECT_NEAR(thrown_m_s(start_s, start_s + 0.0125), 8, 0.2) << start_s << ", and stops within it";
  }
}

// Where a step may be no shorter it is said.
TEST(TurningBodies, AStepThatIsTooLongForThemIsCounted) {
  const std::string parts =
      "[[cloth]]\nsheet = {nx = 4, ny = 4, width_m = 0.1, height_m = 0.1}\nposition_m = [0.5, 0, 0.16]\n" +
      std::string(kMaterial) +
      "[[body]]\nbox = {size_m = [2, 0.05, 0.3]}\nkey = [{time_s = 0}, {time_s = 1, rotation_deg = [0, 0, 10800]}]\n";
  const StepResult free = make("explicit", "frames = 1", parts).step();
  EXPECT_FALSE(free.is_bent);
  EXPECT_LT(free.dt_s, 2e-3);
  const StepResult held = make("explicit", "frames = 1\nmin_step_s = 0.03", parts).step();
  EXPECT_TRUE(held.is_bent);
  RunTotals totals;
  totals.add(held);
  EXPECT_EQ(totals.shortfalls(), "1 steps were too long for a body that turns or turns back within them");
}

/// The farthest that a vertex of a sheet has slipped on a table, which it lies on half a metre from the middle.
double slip_m(const std::string& solver, const std::string& key, const RigidPath& path, double duration_s) {
  Simulation simulation = make(solver, "duration_s = " + std::to_string(duration_s),
                               "gravity_m_s2 = [0, 0, -9.81]\n[collision]\nthickness_m = 0.004\nfriction_static = 0.5\n"
                               "[[cloth]]\nsheet = {nx = 6, ny = 6, width_m = 0.1, height_m = 0.1}\n"
                               "position_m = [0.5, 0, 0.004]\n" +
                                   std::string(kMaterial) +
                                   "[[body]]\nsheet = {nx = 11, ny = 11, width_m = 6, height_m = 6}\n"
                                   "interpolation = \"smooth\"\nkey = [{time_s = 0}, " +
                                   key + "]\n");
  const Positions start = simulation.x().topRows(36);
  double farthest_m = 0;
  while (simulation.clock().time_s() < duration_s - 1e-9) {
    simulation.step();
    const Positions there = place(path.at(simulation.clock().time_s()), start);
    farthest_m = std::max(farthest_m, (simulation.x().topRows(36) - there).rowwise().norm().maxCoeff());
  }
  return farthest_m;
}

// Friction gives 4.9 m/s^2. On straight lines within a step, one of 1/30 s, the sheet slipped by 15 mm and 38 mm.
TEST(TurningBodies, ClothSticksToATrayThatSpeedsUp) {
  const RigidPath path({{0, {}}, {2, {{2.5, 0, 0}, Vec3::Zero()}}}, Interpolation::kSmooth);  // 3.75 m/s^2 at most
  for (const char* solver : {"explicit", "implicit"}) {
    EXPECT_LT(slip_m(solver, "{time_s = 2, position_m = [2.5, 0, 0]}", path, 2), 2e-4) << solver;
  }
}

TEST(TurningBodies, ClothSticksToATableThatTurns) {
  const RigidPath path({{0, {}}, {2, {Vec3::Zero(), {0, 0, 200}}}}, Interpolation::kSmooth);  // 2.6 rad/s, 3.5 m/s^2
  for (const char* solver : {"explicit", "implicit"}) {
    EXPECT_LT(slip_m(solver, "{time_s = 2, rotation_deg = [0, 0, 200]}", path, 2), 2e-4) << solver;
  }
}

}  // namespace
}  // namespace selvage::sim
