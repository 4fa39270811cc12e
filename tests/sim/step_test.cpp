#include "sim/step.h"

#include <type_traits>

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include "sim/record/run_totals.h"
#include "tests/sim/exact_step.h"
#include "tests/sim/physics_support.h"
#include "tests/sim/small_scene.h"

namespace selvage {

using namespace sim;
using namespace sim::testbed;
using testing::small_scene_text;
using testing::violations;

namespace {

Scene small_scene(int frames, const std::string& extra = "", const std::string& collision = "") {
  return parse_scene(small_scene_text(frames, extra, collision), "small.toml");
}

// Copied or moved, as by a vector that grows, it would step in the one that was.
static_assert(!std::is_copy_constructible_v<Simulation> && !std::is_move_constructible_v<Simulation>);
static_assert(!std::is_copy_assignable_v<Simulation> && !std::is_move_assignable_v<Simulation>);

}  // namespace

TEST(Simulation, EveryStepOfADrapeIsExactlyFreeAndBodiesFollowTheirScripts) {
  Simulation simulation(small_scene(14));
  const World& world = simulation.world();
  std::int64_t repulsions = 0, fail_safe_vertices = 0;
  while (simulation.clock().frame() < 14) {
    const Positions before = simulation.x();
    const StepResult step = simulation.step();
    ASSERT_EQ(step.report.status, StepStatus::kSafe);
    EXPECT_EQ(violations(world, before, simulation.x()), 0) << "at " << simulation.clock().time_s() << " s";
    repulsions += step.report.repulsions;
    fail_safe_vertices += step.report.fail_safe_vertices;
    Positions scripted = simulation.x();
    for (const Collider& body : world.colliders)
      body.place_at(simulation.clock().time_s(), sim::Precision::kFloat64, scripted);
    EXPECT_EQ(scripted, simulation.x()) << "S4";
  }
  EXPECT_GT(repulsions, 100) << "the cloth has met the ball";
  EXPECT_EQ(fail_safe_vertices, 0);
}

TEST(Simulation, FreeFallIsExactInPositionAndVelocity) {
  // Central differences are exact for a constant force; the mean velocity of the last step would lag by g dt / 2.
  Simulation simulation(small_scene(3));
  const Eigen::Index cloth = simulation.world().cloth_vertex_count;
  const double height_m = simulation.x()(0, 2);
  while (simulation.clock().frame() < 3) {
    const StepResult step = simulation.step();
    ASSERT_EQ(step.report.repulsions, 0);
    const double t_s = simulation.clock().time_s();
    for (Eigen::Index v = 0; v < cloth; ++v) {
      ASSERT_NEAR(simulation.x()(v, 2), height_m - 0.5 * 9.81 * t_s * t_s, 1e-9);
      ASSERT_NEAR(simulation.state().v(v, 2), -9.81 * t_s, 1e-7);
    }
  }
}

// A sheet 1 m wide that flies by 2 km a frame, farther than a step may go; then one whose step cannot be shortened.
TEST(Simulation, AStepThatGoesTooFarIsShortenedOrSaysThatItWasCut) {
  const std::string sheet =
      "[[cloth]]\nsheet = {nx = 4, ny = 4, width_m = 1, height_m = 1}\ndensity_kg_m2 = 0.2\nstretch_n_m = 40\n"
      "velocity_m_s = [6e4, 0, 0]\n";
  for (const bool can_halve : {true, false}) {
    Simulation simulation(parse_scene(
        "[time]\nframes = 1\n" + std::string(can_halve ? "" : "min_step_s = 0.0333333\n") + sheet, "fast.toml"));
    const double start_m = simulation.x()(0, 0);
    RunTotals totals;
    while (simulation.clock().frame() < 1) totals.add(simulation.step());
    const double way_m = simulation.x()(0, 0) - start_m;
    if (can_halve) {
      EXPECT_NEAR(way_m, 6e4 / 30, 1e-6);
      EXPECT_EQ(totals.shortfalls(), "");
    } else {
      EXPECT_LT(way_m, 2000);
      EXPECT_EQ(totals.cut_candidates, 16);
      EXPECT_NE(totals.shortfalls().find("cut back"), std::string::npos) << totals.shortfalls();
    }
  }
}

namespace {

/// Two sheets meet edge-on at 100 m/s; the shortest step is the scene's where it is given. The longest of all springs,
/// over its rest length, after 40 ms.
double longest_after_edges_meet(const std::string& shortest, RunTotals& totals) {
  const auto sheet = [](const std::string& name, double z, double turn_deg, double speed_m_s) {
    return "[[cloth]]\nname = \"" + name +
           "\"\nsheet = {nx = 12, ny = 12, width_m = 0.25, height_m = 0.25}\nposition_m = [0.01, 0.01, " +
           std::to_string(z) + "]\nrotation_deg = [90, 0, " + std::to_string(turn_deg) + "]\nvelocity_m_s = [0, 0, " +
           std::to_string(speed_m_s) +
           "]\ndensity_kg_m2 = 0.2\nstretch_n_m = 60\nshear_n_m = 20\nbend_n_m = 0.6\nstabilize_n_m = 0.2\n"
           "damping_ratio = 0.1\n";
  };
  Simulation simulation(parse_scene("[time]\nframes_per_s = 200\nduration_s = 0.04\n" + shortest +
                                        "[collision]\nthickness_m = 0.002\nfriction_static = 0.5\n" +
                                        sheet("upper", 0.225, 0, -50) + sheet("lower", -0.225, 90, 50),
                                    "edges.toml"));
  const Positions start = simulation.x();
  while (simulation.clock().time_s() < 0.04 - 1e-9) {
    const StepResult step = simulation.step();
    const bool had_room = step.report.zone_rounds + step.report.fail_safe_rounds == 0;
    EXPECT_TRUE(had_room || simulation.state().loads.empty());
    totals.add(step);
  }
  if (totals.fail_safe_vertices == 0) {
    EXPECT_LT((simulation.x() - start).colwise().mean().norm(), 1e-9) << "both weigh the same";
  }
  double longest = 0;
  for (const Spring& spring : simulation.world().springs.springs()) {
    const double length_m = (simulation.x().row(spring.a) - simulation.x().row(spring.b)).norm();
    longest = std::max(longest, length_m / spring.rest_length_m);
  }
  return longest;
}

}  // namespace

TEST(Simulation, SheetsThatMeetEdgeOnAt100MetersASecondStayWhole) {
  // In steps of the dynamics, in which they go five edges, springs came to 32 times their length; larger sheets needed
  // the fail-safe, which took their momentum.
  RunTotals totals;
  EXPECT_LT(longest_after_edges_meet("", totals), 3);
  EXPECT_LT(totals.steps, 600) << "short ones as long as it is fast; 739 where only good steps were doubled";
  EXPECT_GT(totals.repulsions, 1000);
  EXPECT_EQ(totals.fail_safe_vertices, 0);
}

TEST(Simulation, WhatPressesInAJamIsNotLearntAsWeight) {
  RunTotals totals;
  EXPECT_LT(longest_after_edges_meet("min_step_s = 0.00125\n", totals), 100) << "at steps that are too long";
  EXPECT_GT(totals.zone_rounds, 0);
}

// Of one internal step in each step the dynamics holds nothing, so that all that presses does so behind it. A plate
// that the cloth has fallen on is drawn away below it.
TEST(Simulation, KnowsWhatPressedBehindTheDynamicsInTheLastStep) {
  Simulation simulation(parse_scene(
      "gravity_m_s2 = [0, 0, -9.81]\n[time]\nframes_per_s = 30\nduration_s = 0.1\ndynamics_step_s = 0.002\n"
      "max_step_s = 0.002\n[collision]\nthickness_m = 0.004\n[[cloth]]\nsheet = {nx = 4, ny = 4, width_m = "
      "0.3, height_m = 0.3}\nposition_m = [0, 0, 0.01]\ndensity_kg_m2 = 0.2\nstretch_n_m = 10\n[[body]]\n"
      "sheet = {nx = 2, ny = 2, width_m = 2, height_m = 2}\nkey = [{time_s = 0.06}, {time_s = 0.1, position_m "
      "= [0, 0, -0.2]}]\n",
      "behind.toml"));
  int in_contact = 0, freed = 0;
  while (simulation.clock().time_s() < 0.1 - 1e-9) {
    const StepResult step = simulation.step();
    EXPECT_EQ(step.held_repulsions, 0);
    const bool is_in_flight = step.report.repulsions == 0;
    EXPECT_EQ(simulation.state().pressed == Candidates{}, is_in_flight) << step.end_s;
    in_contact += is_in_flight ? 0 : 1;
    freed += is_in_flight && in_contact > 0 ? 1 : 0;
  }
  EXPECT_GT(in_contact, 0);
  EXPECT_GT(freed, 0);
}

TEST(Simulation, AfterContactGravityActsForTheSecondHalfOfTheStep) {
  // Section 7.6: the velocity at the end is the mean velocity of the safe step and half a step of forces. Springs and
  // the strain-rate limit keep the cloth's momentum, so its change is that of gravity alone. In steps as short as the
  // dynamics': in longer ones contact acts within the dynamics.
  std::string text = small_scene_text(9);
  const std::string steps = "max_step_s = 0.0167\nmin_step_s = 0.004";
  text.replace(text.find(steps), steps.size(), "max_step_s = 0.001");
  Simulation simulation(parse_scene(text, "small.toml"));
  const Eigen::Index cloth = simulation.world().cloth_vertex_count;
  Eigen::VectorXd mass_kg(cloth);
  for (Eigen::Index v = 0; v < cloth; ++v) {
    mass_kg[v] = 1 / simulation.world().inverse_mass[static_cast<std::size_t>(v)];
  }
  int in_contact = 0;
  while (simulation.clock().frame() < 9) {
    const Positions before = simulation.x();
    const StepResult step = simulation.step();
    if (step.report.repulsions == 0) continue;
    ++in_contact;
    const Vec3 mean = ((simulation.x() - before).topRows(cloth) / step.dt_s).transpose() * mass_kg;
    const Vec3 end = simulation.state().v.topRows(cloth).transpose() * mass_kg;
    const Vec3 gravity(0, 0, -9.81 * step.dt_s / 2 * mass_kg.sum());
    ASSERT_LE((end - mean - gravity).norm(), 1e-6 * gravity.norm()) << simulation.clock().time_s();
  }
  EXPECT_GT(in_contact, 5);
}

// The velocity at the end of a step is found anew for cloth that the collision step has changed, and that damps it: no
// other cloth may pay for it.
TEST(Simulation, ClothThatNothingTouchesMovesAsIfItWereAlone) {
  const std::string swings =
      "[[cloth]]\nname = \"swings\"\nsheet = {nx = 8, ny = 8, width_m = 0.5, height_m = 0.5}\n"
      "position_m = [0, 0, 3]\nrotation_deg = [60, 0, 0]\ndensity_kg_m2 = 0.2\nstretch_n_m = 60\nshear_n_m = 20\n"
      "[[cloth.pin]]\nedge = \"top\"\n";
  for (const std::string precision : {"float64", "float32"}) {
    const std::string head =
        "gravity_m_s2 = [0, 0, -9.81]\nstrain_limit = 0\nstrain_rate_limit = 0\n"
        "[time]\nframes_per_s = 60\nframes = 30\nmax_step_s = 0.004\nmin_step_s = 0.004\ndynamics_step_s = 0.0009\n"
        "[collision]\nthickness_m = 0.004\nprecision = \"" +
        precision + "\"\n" + swings;
    Simulation alone(parse_scene(head, "alone.toml"));
    Simulation beside(parse_scene(head + sheet("lies", 0.0045, 0) + plane(), "beside.toml"));
    std::int64_t repulsions = 0;
    while (beside.clock().time_s() < 0.5 - 1e-9) repulsions += beside.step().report.repulsions;
    EXPECT_GT(repulsions, 100) << "the other one lies on something";
    EXPECT_EQ(run_to(alone, 0.5).topRows(64), beside.x().topRows(64)) << precision;
    EXPECT_EQ(alone.state().v.topRows(64), beside.state().v.topRows(64)) << precision;
  }
}

TEST(Simulation, SameBitsForAnyThreadCount) {
  Positions reference;
  for (const std::size_t threads : {1u, 2u, 4u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Simulation simulation(small_scene(9));
    while (simulation.clock().frame() < 9) ASSERT_EQ(simulation.step().report.status, StepStatus::kSafe);
    if (threads == 1) reference = simulation.x();
    EXPECT_EQ(simulation.x(), reference) << threads << " threads";
  }
}

TEST(Simulation, Float32StatesLieOnTheLattice) {
  Simulation simulation(small_scene(8, "", "precision = \"float32\"\n"));
  const auto on_lattice = [&] { return simulation.x() == Positions(simulation.x().cast<float>().cast<double>()); };
  EXPECT_TRUE(on_lattice());
  while (simulation.clock().frame() < 8) {
    ASSERT_EQ(simulation.step().report.status, StepStatus::kSafe);
    ASSERT_TRUE(on_lattice());
  }
}

/// More than a few collisions, or any that impulses do not settle soon, are left to the shortest step.
TEST(Simulation, LongerStepsThanTheShortestBearAFewCollisionsAtMost) {
  // Dropped on its edge it crumples: folds meet that no contact held.
  Simulation simulation(parse_scene(R"(
gravity_m_s2 = [0, 0, -9.81]
[time]
frames_per_s = 30
frames = 12
min_step_s = 0.001
[collision]
thickness_m = 0.0005
[[cloth]]
sheet = {nx = 40, ny = 40, width_m = 0.6, height_m = 0.6}
position_m = [0, 0, 0.32]
rotation_deg = [86, 0, 3]
velocity_m_s = [0, 0, -3]
density_kg_m2 = 0.2
stretch_n_m = 60
shear_n_m = 20
bend_n_m = 0.1
damping_ratio = 0.1
[[body]]
sheet = {nx = 2, ny = 2, width_m = 8, height_m = 8}
)",
                                    "edge-on.toml"));
  int borne = 0, refused = 0;
  while (simulation.clock().frame() < 12) {
    const StepResult step = simulation.step();
    ASSERT_EQ(step.report.status, StepStatus::kSafe);
    refused += step.halvings;
    if (step.dt_s < 2e-3) continue;  // the shortest is between 1 and 2 ms
    EXPECT_LE(step.report.first_collisions, 40 * 40 / 400);
    EXPECT_LE(step.report.impulse_rounds, 4);
    EXPECT_EQ(step.report.zone_rounds, 0);
    borne += step.report.first_collisions > 0;
  }
  EXPECT_GT(borne, 0);
  EXPECT_GT(refused, 0);
}

TEST(Simulation, DynamicsHoldsTheCollisionsThatRepulsionsLeave) {
  // Two sheets meet at 12 m/s: 270 thicknesses a step. Nothing is near at the start of it, and repulsions do not act.
  const std::string sheet =
      "sheet = {nx = 6, ny = 6, width_m = 0.3, height_m = 0.3}\ndensity_kg_m2 = 0.3\n"
      "stretch_n_m = 40\nshear_n_m = 20\n";
  const std::string text =
      "[time]\nframes_per_s = 15\nframes = 1\n[collision]\nthickness_m = 0.003\n"
      "[[cloth]]\nname = \"upper\"\n" +
      sheet +
      "position_m = [0.01, 0.02, 0.3]\n"
      "velocity_m_s = [0, 0, -6]\n[[cloth]]\nname = \"lower\"\n" +
      sheet + "position_m = [0, 0, -0.3]\nvelocity_m_s = [0, 0, 6]\n";
  Simulation simulation(parse_scene(text, "meet.toml"));
  const Positions before = simulation.x();
  const StepResult step = simulation.step();
  ASSERT_EQ(step.report.status, StepStatus::kSafe);
  EXPECT_EQ(step.halvings, 0);
  EXPECT_EQ(step.report.first_collisions, 0);
  EXPECT_GT(step.report.repulsions, 20);
  EXPECT_EQ(violations(simulation.world(), before, simulation.x()), 0);
  // Inelastic: they stop each other, a thickness apart; what does not lie over the other goes on a little.
  const auto mean_z = [](const Positions& rows, Eigen::Index first) {
    return rows.middleRows(first, 36).col(2).mean();
  };
  const SimulationState state = simulation.state();
  EXPECT_NEAR(mean_z(state.v, 0), 0, 0.3);
  EXPECT_NEAR(mean_z(state.v, 36), 0, 0.3);
  EXPECT_NEAR(mean_z(state.x, 0) - mean_z(state.x, 36), 0.003, 0.003);
}

TEST(Simulation, WithoutRepulsionsTheShortestStepResolvesWhatItMustNotHold) {
  Scene scene = small_scene(8);  // steps of 4 ms and more hold contacts
  scene.collision.repulsion = false;
  Simulation simulation(scene);
  std::int64_t collisions = 0;
  while (simulation.clock().frame() < 8) {
    const Positions before = simulation.x();
    const StepResult step = simulation.step();
    ASSERT_EQ(step.report.status, StepStatus::kSafe);
    ASSERT_EQ(violations(simulation.world(), before, simulation.x()), 0);
    EXPECT_EQ(step.report.repulsions, 0);
    collisions += step.report.first_collisions;
  }
  EXPECT_GT(collisions, 0);
}

TEST(Simulation, StepsAreHalvedWhereContactStrainsTheSpringsThatItHolds) {
  // A sheet falls on its edge. Where steps were halved for collisions alone, contact held the edge for 1/60 s while the
  // sheet fell on.
  Simulation simulation(parse_scene(R"(
gravity_m_s2 = [0, 0, -9.81]
[time]
frames_per_s = 30
frames = 15
max_step_s = 0.0166667
[collision]
thickness_m = 0.004
friction_static = 0.4
[[cloth]]
sheet = {nx = 16, ny = 16, width_m = 1, height_m = 1}
position_m = [0, 0, 0.51]
rotation_deg = [90, 0, 0]
density_kg_m2 = 0.2
stretch_n_m = 40
shear_n_m = 12
bend_n_m = 0.4
damping_ratio = 0.2
[[body]]
sheet = {nx = 2, ny = 2, width_m = 8, height_m = 8}
)",
                                    "edge-on.toml"));
  double largest = 0;
  while (simulation.clock().frame() < 15) {
    const StepResult step = simulation.step();
    double now = 0;
    for (const Spring& spring : simulation.world().springs.springs()) {
      if (spring.kind == SpringKind::kBending) continue;
      const double length_m = (simulation.x().row(spring.a) - simulation.x().row(spring.b)).norm();
      now = std::max(now, std::abs(length_m / spring.rest_length_m - 1));
    }
    EXPECT_EQ(step.most_strained.strain, now);
    EXPECT_EQ(step.end_s, simulation.clock().time_s());
    largest = std::max(largest, now);
  }
  EXPECT_LT(largest, 0.3);
}

TEST(Simulation, StepsAreHalvedWhereRepulsionsAreNotEnough) {
  // Half a metre a step at first: the cloth would jump over the floor.
  Scene scene = parse_scene(R"(
[time]
frames_per_s = 10
frames = 3
min_step_s = 0.003
[[cloth]]
sheet = {nx = 4, ny = 4, width_m = 0.3, height_m = 0.3}
position_m = [0, 0, 0.5]
velocity_m_s = [0, 0, -6]
density_kg_m2 = 0.3
stretch_n_m = 40
shear_n_m = 20
[[body]]
sheet = {nx = 2, ny = 2, width_m = 6, height_m = 6}
)",
                            "fall.toml");
  scene.collision.repulsion = false;  // nor do the dynamics hold any contact
  Simulation simulation(scene);
  const StepResult first = simulation.step();
  ASSERT_EQ(first.report.status, StepStatus::kSafe);
  EXPECT_GT(first.halvings, 0);
  EXPECT_LT(first.dt_s, 0.1);
  EXPECT_EQ(first.report.first_collisions, 0) << "half steps until the cloth has not reached the floor";
  double shortest = 1;
  while (simulation.clock().frame() < 3) {
    const StepResult step = simulation.step();
    ASSERT_EQ(step.report.status, StepStatus::kSafe);
    shortest = std::min(shortest, step.dt_s);
    EXPECT_TRUE(step.report.first_collisions == 0 || step.dt_s < 0.00625) << "collisions at the shortest step only";
  }
  EXPECT_EQ(shortest, 0.1 / 32);
  EXPECT_GT(simulation.x().topRows(16).col(2).minCoeff(), 0);
}

TEST(Simulation, PinsHoldAndLetGo) {
  Simulation simulation(parse_scene(R"(
gravity_m_s2 = [0, 0, -9.81]
[time]
frames = 20
[[cloth]]
sheet = {nx = 5, ny = 5, width_m = 0.4, height_m = 0.4}
density_kg_m2 = 0.3
stretch_n_m = 40
shear_n_m = 20
damping_ratio = 0.2
[[cloth.pin]]
edge = "top"
release_s = 0.4
)",
                                    "pins.toml"));
  const Positions start = simulation.x();
  while (simulation.clock().time_s() < 0.4) ASSERT_EQ(simulation.step().report.status, StepStatus::kSafe);
  EXPECT_EQ(Positions(simulation.x().middleRows(20, 5)), Positions(start.middleRows(20, 5)));
  EXPECT_LT(simulation.x()(2, 2), -0.05) << "the free edge has swung down";
  while (simulation.clock().frame() < 20) ASSERT_EQ(simulation.step().report.status, StepStatus::kSafe);
  EXPECT_LT(simulation.x()(22, 2), start(22, 2) - 0.1) << "free fall since the release";
}

TEST(Simulation, ClothThatIsPinnedAllOverStopsAtABody) {
  // Nothing of it has mass until its pin lets go, inside the ball if nobody looks.
  Simulation simulation(parse_scene(R"(
[time]
frames_per_s = 30
frames = 12
[collision]
thickness_m = 0.004
[[cloth]]
name = "flag"
sheet = {nx = 3, ny = 3, width_m = 1, height_m = 1}
position_m = [0, 0, 1]
density_kg_m2 = 0.2
stretch_n_m = 60
shear_n_m = 20
[[cloth.pin]]
vertices = [0, 1, 2, 3, 4, 5, 6, 7, 8]
release_s = 0.3
key = [{time_s = 0}, {time_s = 0.2, position_m = [0, 0, -1]}]
[[body]]
name = "ball"
sphere = {radius_m = 0.3, subdivisions = 2}
)",
                                    "pinned.toml"));
  StepStatus status = StepStatus::kSafe;
  for (int step = 0; step < 100 && status == StepStatus::kSafe; ++step) {
    const Positions before = simulation.x();
    status = simulation.step().report.status;
    ASSERT_EQ(violations(simulation.world(), before, simulation.x()), 0) << simulation.clock().time_s();
  }
  EXPECT_EQ(status, StepStatus::kStopped);
}

}  // namespace selvage
