// Cloth that lies on cloth, on a ball, or over an edge keeps its distances and stays where it is.
#include <algorithm>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "sim/scene/scene_reader.h"
#include "sim/step.h"
#include "tests/sim/exact_step.h"
#include "tests/sim/physics_support.h"

namespace selvage {

using namespace sim;
using namespace sim::testbed;

namespace {

/// A square that lies on another, on a plane, both 4 mm thick.
std::string square_on_square(const std::string& under, const std::string& over, const std::string& friction) {
  return "gravity_m_s2 = [0, 0, -9.81]\n[time]\nframes_per_s = 30\nduration_s = 0.4\n"
         "[collision]\nthickness_m = 0.004\nfriction_static = " +
         friction + "\n[[cloth]]\nname = \"under\"\nposition_m = [0, 0, 0.0041]\ndamping_ratio = 0.1\n" + under +
         "[[cloth]]\nname = \"over\"\nposition_m = [0.003, 0.002, 0.0085]\nrotation_deg = [0, 0, 20]\ndamping_ratio = "
         "0.1\n" +
         over + plane();
}

/// How `count` vertices of cloth from `first` on lie while it is at rest: from 0.1 s to the end of the scene.
struct Lying {
  double lowest_m = 1, highest_m = 0, fastest_rise_m_s = 0;
};
void look(const Simulation& simulation, VertexId first, VertexId count, Lying& lying) {
  if (simulation.clock().time_s() < 0.1) return;
  const SimulationState state = simulation.state();
  lying.lowest_m = std::min(lying.lowest_m, state.x.col(2).segment(first, count).minCoeff());
  lying.highest_m = std::max(lying.highest_m, state.x.col(2).segment(first, count).maxCoeff());
  lying.fastest_rise_m_s = std::max(lying.fastest_rise_m_s, state.v.col(2).segment(first, count).maxCoeff());
}

/// A sheet of 0.6 m that falls on a ball and hangs down to the ground.
struct Drape {
  std::string vertices, thickness_m, turned_deg;
  std::string longest_step;  ///< a line of the scene; a frame without
};

/// What moves most in a frame of the last of so many seconds, m.
double most_in_a_frame_m(const Drape& drape, std::int64_t seconds) {
  Simulation simulation(parse_scene(
      "gravity_m_s2 = [0, 0, -9.81]\ndrag_1_s = 1\n[time]\nframes_per_s = 30\nduration_s = " + std::to_string(seconds) +
          "\n" + drape.longest_step + "[collision]\nthickness_m = " + drape.thickness_m +
          "\nfriction_static = 0.5\nfriction_kinetic = 0.4\n[[cloth]]\nsheet = {nx = " + drape.vertices + ", ny = " +
          drape.vertices + ", width_m = 0.6, height_m = 0.6}\nposition_m = [0, 0, 0.32]\nrotation_deg = [0, 0, " +
          drape.turned_deg + "]\ndensity_kg_m2 = 0.2\nstretch_n_m = 60\nshear_n_m = 20\nbend_n_m = 0.6\n" +
          "damping_ratio = 0.1\n[[body]]\nsphere = {radius_m = 0.15}\nposition_m = [0, 0, 0.15]\n" + plane(),
      "drape.toml"));
  double result = 0;
  for (std::int64_t frame = 0; frame < 30 * seconds; ++frame) {
    const Positions x = simulation.x();
    while (simulation.clock().frame() == frame) simulation.step();
    if (frame >= 30 * (seconds - 1)) result = std::max(result, (simulation.x() - x).rowwise().norm().maxCoeff());
  }
  return result;
}

}  // namespace

TEST(Rest, SheetsThatLieOnOneAnotherKeepTheirDistances) {
  // Of 30 mm 29.9 are left, 27.0 where edges remembered nothing. Where loads ended with a collision step 19.1 were,
  // without loads 18.2, and 17 tries were thrown away; 23.1 where what rests was held from the second round on. The
  // implicit solver keeps all of them.
  constexpr int kLayers = 10, kVertices = 4 * 4;
  for (const auto& [solver, kept] : {std::pair("explicit", 0.99), {"implicit", 0.99}}) {
    Simulation simulation(
        parse_scene("solver = \"" + std::string(solver) + "\"\n" +
                        "gravity_m_s2 = [0, 0, -9.81]\ndrag_1_s = 0.3\n[time]\nframes_per_s = 30\nduration_s = 0.5\n"
                        "max_step_s = 0.0166667\n[collision]\nthickness_m = 0.003\nfriction_static = 0.3\n"
                        "[[cloth]]\nsheet = {nx = 4, ny = 4, width_m = 0.045, height_m = 0.045}\ncopies = 10\n"
                        "copy_offset_m = [0, 0, 0.0032]\nposition_m = [0, 0, 0.0032]\ndensity_kg_m2 = 0.2\n"
                        "stretch_n_m = 60\nshear_n_m = 20\nbend_n_m = 0.6\ndamping_ratio = 0.1\n" +
                        plane(),
                    "stack.toml"));
    std::int64_t halvings = 0;
    while (simulation.clock().time_s() < 0.5 - 1e-9) halvings += simulation.step().halvings;
    EXPECT_EQ(halvings, 0) << solver;
    const double top = mean(simulation.x(), kVertices * (kLayers - 1), kVertices * kLayers).z();
    EXPECT_GT(top, kept * kLayers * 0.003) << solver;
  }
}

TEST(Rest, SheetsThatLieOnOneAnotherStayWhereTheyAre) {
  // In the second second the uppermost moves by 0.05 mm with one sweep and by 0.005 with four, up; by 0.28 and 0.05
  // where edges remembered nothing, and by 5.2 and 25, sideways, where contacts did not remember their friction.
  constexpr int kLayers = 8, kVertices = 6 * 6;
  for (const auto& [sweeps, most_m] : {std::pair(1, 1e-4), {4, 2e-5}}) {
    for (const std::string friction : {"0.3\nfriction_kinetic = 0.1", "1e6"}) {
      Simulation simulation(
          parse_scene("gravity_m_s2 = [0, 0, -9.81]\n[time]\nframes_per_s = 30\nduration_s = 2\n"
                      "[collision]\nthickness_m = 0.004\nfriction_static = " +
                          friction + "\ncontact_sweeps = " + std::to_string(sweeps) +
                          "\n[[cloth]]\nsheet = {nx = 6, ny = 6, width_m = 0.3, height_m = 0.3}\ncopies = 8\n"
                          "copy_offset_m = [0.003, 0.002, 0.004]\nposition_m = [0, 0, 0.004]\ndensity_kg_m2 = 0.2\n"
                          "stretch_n_m = 60\nshear_n_m = 20\nbend_n_m = 0.6\nstabilize_n_m = 0.2\n"
                          "damping_ratio = 0.1\n" +
                          plane(),
                      "rest.toml"));
      const Positions settled = run_to(simulation, 1), end = run_to(simulation, 2);
      for (int layer = 0; layer < kLayers; ++layer) {
        const VertexId first = layer * kVertices, last = first + kVertices;
        const Vec3 moved = mean(end, first, last) - mean(settled, first, last);
        EXPECT_LT(moved.norm(), most_m) << "layer " << layer << ", " << sweeps << " sweeps, friction " << friction;
      }
    }
  }
}

TEST(Rest, SheetsWhoseVerticesLieOverVerticesKeepTheirDistances) {
  // Each vertex lies over a corner of six faces, any of which may be found to bear it. Of 40 mm 37.7 are left;
  // 29.0, and 2 tries were thrown away, where edges remembered nothing; 25.5, and 7, where a load was lost with the
  // face that bore it.
  constexpr int kLayers = 10, kVertices = 6 * 6;
  Simulation simulation(
      parse_scene("gravity_m_s2 = [0, 0, -9.81]\n[time]\nframes_per_s = 30\nduration_s = 0.5\n"
                  "[collision]\nthickness_m = 0.004\nfriction_static = 0.3\n"
                  "[[cloth]]\nsheet = {nx = 6, ny = 6, width_m = 0.25, height_m = 0.25}\ncopies = 10\n"
                  "copy_offset_m = [0, 0, 0.0041]\nposition_m = [0, 0, 0.0041]\ndensity_kg_m2 = 0.2\n"
                  "stretch_n_m = 60\nshear_n_m = 20\nbend_n_m = 0.6\nstabilize_n_m = 0.2\ndamping_ratio = 0.1\n"
                  "[[body]]\nsheet = {nx = 11, ny = 11, width_m = 0.5, height_m = 0.5}\n",
                  "aligned.toml"));
  std::int64_t halvings = 0;
  while (simulation.clock().time_s() < 0.5 - 1e-9) halvings += simulation.step().halvings;
  EXPECT_EQ(halvings, 0);
  const double top = mean(simulation.x(), kVertices * (kLayers - 1), kVertices * kLayers).z();
  EXPECT_GT(top, 0.92 * kLayers * 0.004);
}

TEST(Rest, SheetsThatDropOnABallKeepTheirDistancesUnderMoreSweeps) {
  // The least distance of neighbours, in the middle, where they lie on the ball: 2.2 to 2.6 mm of 3, as rounding goes,
  // 0.9 with one sweep; 1.4 where contacts do not keep the order of their vertices (sim/dynamics/contact_groups.cpp).
  constexpr int kLayers = 16, kSide = 8;
  Simulation simulation(
      parse_scene("gravity_m_s2 = [0, 0, -9.81]\ndrag_1_s = 0.3\n[time]\nframes_per_s = 30\nduration_s = 0.3\n"
                  "max_step_s = 0.0166667\n[collision]\nthickness_m = 0.003\nfriction_static = 0.3\n"
                  "contact_sweeps = 4\n"
                  "[[cloth]]\nsheet = {nx = 8, ny = 8, width_m = 0.1, height_m = 0.1}\ncopies = 16\n"
                  "copy_offset_m = [0, 0, 0.008]\nposition_m = [0, 0, 0.035]\ndensity_kg_m2 = 0.2\n"
                  "stretch_n_m = 60\nshear_n_m = 20\nbend_n_m = 0.6\ndamping_ratio = 0.1\n"
                  "[[body]]\nsphere = {radius_m = 0.02, subdivisions = 2}\n",
                  "drop.toml"));
  run_to(simulation, 0.3);
  const auto middle_m = [&](int layer) {
    const VertexId row = kSide * (layer * kSide + kSide / 2 - 1) + kSide / 2 - 1;
    return Vec3((mean(simulation.x(), row, row + 2) + mean(simulation.x(), row + kSide, row + kSide + 2)) / 2);
  };
  for (int layer = 1; layer < kLayers; ++layer) {
    EXPECT_GT((middle_m(layer) - middle_m(layer - 1)).norm(), 0.0022) << layer;
  }
}

// In steps as long as a frame, too: each went on moving, by 5 mm a frame, when a share of what cloth falls in such a
// step was a kick that was borne (sim/step_allowance.cpp).
TEST(Rest, SheetsDrapedOverABallComeToRestInStepsOfAFrame) {
  EXPECT_LT(most_in_a_frame_m({"20", "0.006", "80", {}}, 6), 5e-4);
  EXPECT_LT(most_in_a_frame_m({"25", "0.005", "80", {}}, 6), 5e-4);
}

// Where contacts of the hems that nothing but springs pressed were held in every other step, these moved by 3.5 and 1.6
// mm a frame, for ever; they move by 0.01 and 0.02 (Simulation::likely_contacts).
TEST(Rest, HemsOfSheetsDrapedOverABallComeToRest) {
  EXPECT_LT(most_in_a_frame_m({"25", "0.005", "50", {}}, 12), 5e-4);
  EXPECT_LT(most_in_a_frame_m({"25", "0.005", "0", "max_step_s = 0.0166667\n"}, 12), 5e-4);
}

// Springs alone press it on the ball. Where it was held only if a flight without springs pressed it, the dynamics
// pulled it in and the collision step threw it out in every step, for ever.
TEST(Rest, UnderTheImplicitSolverClothDrawnOverABallWithoutGravityComesToRest) {
  constexpr int kSide = 12;
  std::string border;
  for (int i = 0; i < kSide * kSide; ++i) {
    const int row = i / kSide, column = i % kSide;
    if (row % (kSide - 1) == 0 || column % (kSide - 1) == 0) border += std::to_string(i) + ", ";
  }
  Simulation simulation(parse_scene(
      "solver = \"implicit\"\nstrain_limit = 0\n[time]\nframes_per_s = 30\nduration_s = 2\n[collision]\nthickness_m = "
      "0.004\nfriction_static = 0.4\n[[cloth]]\nsheet = {nx = 12, ny = 12, width_m = 1, height_m = 1}\nposition_m = "
      "[0.01, 0.02, 0.31]\ndensity_kg_m2 = 0.2\nstretch_n_m = 100\nshear_n_m = 30\nbend_n_m = 0.3\ndamping_ratio = "
      "0.5\n[[cloth.pin]]\nvertices = [" +
          border +
          "]\ninterpolation = \"smooth\"\nkey = [{time_s = 0}, {time_s = 0.5, position_m = [0, 0, -0.3]}]\n[[body]]\n"
          "sphere = {radius_m = 0.3}\n",
      "drum.toml"));
  run_to(simulation, 1.5);
  double most_in_a_step_m = 0;
  while (simulation.clock().time_s() < 2 - 1e-9) {
    const Positions x = simulation.x();
    simulation.step();
    most_in_a_step_m = std::max(most_in_a_step_m, (simulation.x() - x).rowwise().norm().maxCoeff());
  }
  EXPECT_LT(most_in_a_step_m, 1e-5) << "m";
}

TEST(Rest, SheetOverTheEdgeOfABoxComesToRest) {
  // Its weight and its friction hold it with room to spare: 43 % hangs, and an edge turned by 90 degrees divides the
  // pull by exp(0.6 pi / 2) = 2.6. It moved by 6 mm in the fifth second, at steps of 1/60 s or a tenth of that, when
  // contacts ended at the thickness (kContactReach). Of 12 x 12 vertices it moved by 0.3 mm where the box's vertices
  // remembered the friction under them (SweptContacts::bear), and moves by 0.01.
  for (const int side : {8, 12}) {
    Simulation simulation(
        parse_scene("gravity_m_s2 = [0, 0, -9.81]\ndrag_1_s = 4\n[time]\nframes_per_s = 30\nduration_s = 5\n"
                    "max_step_s = 0.0166667\n[collision]\nthickness_m = 0.004\nfriction_static = 0.6\n"
                    "[[cloth]]\nsheet = {nx = " +
                        std::to_string(side) + ", ny = " + std::to_string(side) +
                        ", width_m = 0.6, height_m = 0.6}\nposition_m = [0.12, 0, 0.005]\n"
                        "density_kg_m2 = 0.2\nstretch_n_m = 40\nshear_n_m = 12\nbend_n_m = 0.4\ndamping_ratio = 0.4\n"
                        "[[body]]\nbox = {size_m = [1, 1, 0.4], cells = 4}\nposition_m = [-0.3, 0, -0.2]\n",
                    "edge.toml"));
    const Positions early = run_to(simulation, 4), late = run_to(simulation, 5);
    EXPECT_LT((late - early).topRows(side * side).rowwise().norm().maxCoeff(), 2e-4) << "m";
  }
}

// Where one sweep of contacts is not enough, steps were halved until hardly any of the dynamics' own was left: 234.
TEST(Rest, WhatRestsIsSolvedInAFewRounds) {
  // A solution that began without the friction or the edges of the last step's took 39 rounds, and takes 8.
  const std::string square =
      "sheet = {nx = 10, ny = 10, width_m = 0.3, height_m = 0.3}\ndensity_kg_m2 = 0.2\nstretch_n_m = 60\nshear_n_m = "
      "20\n"
      "bend_n_m = 0.6\n";
  Simulation simulation(parse_scene("solver = \"implicit\"\n" + square_on_square(square, square, "0.4"), "rest.toml"));
  (void)run_to(simulation, 0.2);
  std::int64_t solves = 0, rounds = 0, contacts = 0;
  while (simulation.clock().time_s() < 0.4 - 1e-9) {
    const StepResult step = simulation.step();
    solves += step.dynamics.solves;
    rounds += step.dynamics.newton_rounds;
    contacts += step.held_repulsions;
  }
  EXPECT_GT(contacts, 100 * solves) << "they lie on one another";
  EXPECT_LT(rounds, 12 * solves);
}

TEST(Rest, HeavyClothOnLightClothTakesLongSteps) {
  Simulation simulation(parse_scene(R"(gravity_m_s2 = [0, 0, -9.81]
[time]
frames_per_s = 30
duration_s = 0.6
[collision]
thickness_m = 0.006
friction_static = 0.4
[[cloth]]
name = "veil"
copies = 2
copy_offset_m = [0, 0, 0.009]
sheet = {nx = 12, ny = 12, width_m = 0.6, height_m = 0.6}
position_m = [0.01, 0.02, 0.17]
density_kg_m2 = 0.02
stretch_n_m = 30
shear_n_m = 10
bend_n_m = 0.05
damping_ratio = 0.1
[[cloth]]
name = "carpet"
sheet = {nx = 12, ny = 12, width_m = 0.5, height_m = 0.5}
position_m = [0, 0, 0.22]
rotation_deg = [0, 0, 20]
density_kg_m2 = 2
stretch_n_m = 400
shear_n_m = 200
bend_n_m = 5
damping_ratio = 0.1
[[body]]
name = "ball"
sphere = {radius_m = 0.15}
)",
                                    "carpet.toml"));
  std::int64_t steps = 0;
  selvage::testing::run_exactly_free(simulation, simulation.scene().time.frame_count,
                                     [&](const StepResult&) { ++steps; });
  EXPECT_LT(steps, 120);
}

// As heavy, but with vertices 33 times as heavy. They stay within 0.2 micrometres of their height, and nothing rises;
// under one sweep they were thrown up at 0.5 m/s, to 10.9 mm above the plane in place of 8, and with friction to 15.6
// (contact_sweeps.h).
TEST(Rest, FineClothUnderCoarseClothStaysDown) {
  constexpr VertexId kUnder = 25 * 25, kOver = 4 * 4;
  const std::string springs = "density_kg_m2 = 0.2\nstretch_n_m = 60\nshear_n_m = 20\nbend_n_m = 0.6\n";
  for (const std::string friction : {"0", "0.3"}) {
    SCOPED_TRACE(friction);
    Simulation simulation(
        parse_scene(square_on_square("sheet = {nx = 25, ny = 25, width_m = 0.2, height_m = 0.2}\n" + springs,
                                     "sheet = {nx = 4, ny = 4, width_m = 0.15, height_m = 0.15}\n" + springs, friction),
                    "fine.toml"));
    Lying under, over;
    selvage::testing::run_exactly_free(simulation, simulation.scene().time.frame_count, [&](const StepResult&) {
      look(simulation, 0, kUnder, under);
      look(simulation, kUnder, kOver, over);
    });
    EXPECT_LT(std::max(under.fastest_rise_m_s, over.fastest_rise_m_s), 0.02);
    EXPECT_GT(under.lowest_m, 0.00398);
    EXPECT_LT(under.highest_m, 0.00402);
    EXPECT_GT(over.lowest_m, 0.00796);
    EXPECT_LT(over.highest_m, 0.00804);
  }
}

// 100 times as heavy. Of the veil 3.8 mm of 4 are left where it is thinnest, of both 7.7 of 8; 0.005 and 4.0 under one
// sweep.
TEST(Rest, LightClothUnderHeavyClothKeepsItsThickness) {
  constexpr VertexId kUnder = 8 * 8, kOver = 8 * 8;
  for (const std::string friction : {"0", "0.3"}) {
    SCOPED_TRACE(friction);
    Simulation simulation(
        parse_scene(square_on_square("sheet = {nx = 8, ny = 8, width_m = 0.2, height_m = 0.2}\n"
                                     "density_kg_m2 = 0.02\nstretch_n_m = 30\nshear_n_m = 10\nbend_n_m = 0.05\n",
                                     "sheet = {nx = 8, ny = 8, width_m = 0.13, height_m = 0.13}\n"
                                     "density_kg_m2 = 2\nstretch_n_m = 300\nshear_n_m = 100\nbend_n_m = 0.6\n",
                                     friction),
                    "veil.toml"));
    Lying under, over;
    selvage::testing::run_exactly_free(simulation, simulation.scene().time.frame_count, [&](const StepResult&) {
      look(simulation, 0, kUnder, under);
      look(simulation, kUnder, kOver, over);
    });
    EXPECT_GT(under.lowest_m, 0.0035);
    EXPECT_GT(over.lowest_m, 0.0074);
    EXPECT_LT(std::max(under.fastest_rise_m_s, over.fastest_rise_m_s), 0.1);
  }
}

}  // namespace selvage
