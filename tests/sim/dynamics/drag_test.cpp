// A sheet in free flight through still air: its speed and its way have closed forms.
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim/dynamics/drag_steps.h"
#include "sim/scene/scene_reader.h"
#include "sim/step.h"
#include "tests/sim/physics_support.h"

namespace selvage {

using namespace sim;
using namespace sim::testbed;

namespace {

constexpr VertexId kVertices = 36;

struct Flight {
  double drag_1_s, quadratic_drag_1_m, v_t0;
  [[nodiscard]] double way_m(double time_s) const {
    // With linear drag alone, which the other one slows down further.
    const double linear_m = drag_1_s > 0 ? v_t0 * -std::expm1(-drag_1_s * time_s) / drag_1_s : v_t0 * time_s;
    return quadratic_drag_1_m > 0 ? std::log1p(quadratic_drag_1_m * linear_m) / quadratic_drag_1_m : linear_m;
  }
};

/// Its ways at the ends of the steps, of a 30th of a second each, and the state in the end.
struct Flown {
  std::vector<double> way_m;
  SimulationState end;
};
Flown fly(const std::string& solver, const Flight& flight) {
  Simulation simulation(parse_scene(
      "solver = \"" + solver + "\"\ndrag_1_s = " + std::to_string(flight.drag_1_s) +
          "\nquadratic_drag_1_m = " + std::to_string(flight.quadratic_drag_1_m) +
          "\n[time]\nframes_per_s = 30\nframes = 4\n[[cloth]]\nname = \"sheet\"\nsheet = {nx = 6, ny = 6, width_m = 1, "
          "height_m = 1}\ndensity_kg_m2 = 0.05\nstretch_n_m = 5\nshear_n_m = 2\nvelocity_m_s = [" +
          std::to_string(flight.v_t0) + ", 0, 0]\n",
      "flight.toml"));
  const Vec3 start = mean(simulation.x(), 0, kVertices);
  Flown flown;
  while (simulation.clock().time_s() < 4.0 / 30 - 1e-9) {
    simulation.step();
    flown.way_m.push_back((mean(simulation.x(), 0, kVertices) - start).x());
  }
  flown.end = simulation.state();
  return flown;
}

}  // namespace

TEST(Drag, StopsAMotionAndNeverTurnsItRound) {
  for (const std::string solver : {"explicit", "implicit"}) {
    for (const Flight& flight : {Flight{1000, 0, 1}, Flight{1e5, 0, 1}, Flight{100, 0, 1}, Flight{0, 15, 20},
                                 Flight{0, 15, 300}, Flight{0, 50, 100}, Flight{0, 1000, 10}, Flight{0, 1000, 1000},
                                 Flight{1e6, 0.01, 1}, Flight{1e6, 1000, 1000}}) {
      const Flown flown = fly(solver, flight);
      double before_m = 0;
      for (const double way_m : flown.way_m) {
        EXPECT_GE(way_m, before_m - 1e-9)
            << solver << ", " << flight.quadratic_drag_1_m << " 1/m, " << flight.v_t0 << " m/s";
        before_m = way_m;
      }
      EXPECT_GE(flown.end.v.col(0).minCoeff(), -1e-7) << "a residual of 1e-9 m in a step of 1/120 s";
    }
  }
}

TEST(Drag, TakesCloseToItsClosedForm) {
  for (const std::string solver : {"explicit", "implicit"}) {
    for (const Flight& flight : {Flight{1, 0, 1}, Flight{30, 0, 1}, Flight{1000, 0, 1}, Flight{1e5, 0, 1}}) {
      const double way_m = flight.way_m(4.0 / 30);
      EXPECT_NEAR(fly(solver, flight).way_m.back(), way_m, 0.01 * way_m) << solver << ", " << flight.drag_1_s;
    }
    for (const Flight& flight : {Flight{0, 1, 3}, Flight{0, 15, 20}, Flight{0, 7, 50}, Flight{0, 15, 300},
                                 Flight{10, 1, 3}, Flight{1000, 7, 50}, Flight{1e6, 0.01, 1}}) {
      const double way_m = flight.way_m(4.0 / 30);
      EXPECT_NEAR(fly(solver, flight).way_m.back(), way_m, 0.1 * way_m) << solver << ", " << flight.quadratic_drag_1_m;
    }
  }
}

// Where drag holds gravity, nothing changes any more, however the step is parted: damping, which acts on nothing here,
// is what makes the march take many steps.
TEST(Drag, LetsClothFallOnAtItsTerminalSpeed) {
  constexpr double kDrag_1_s = 2, kQuadratic_1_m = 4, kDown_m_s2 = 9.81;
  const double terminal_m_s =
      (std::sqrt(kDrag_1_s * kDrag_1_s + 4 * kQuadratic_1_m * kDown_m_s2) - kDrag_1_s) / (2 * kQuadratic_1_m);
  for (const char* damping : {"0", "1", "5"}) {
    Simulation simulation(parse_scene(
        std::string("gravity_m_s2 = [0, 0, -9.81]\ndrag_1_s = 2\nquadratic_drag_1_m = 4\n[time]\nframes_per_s = "
                    "30\nduration_s = 3\ndynamics_step_s = 0.02\n[[cloth]]\nname = \"sheet\"\nsheet = {nx = 6, ny = "
                    "6, width_m = 1, height_m = 1}\ndensity_kg_m2 = 0.2\nstretch_n_m = 2\ndamping_ratio = ") +
            damping + "\n",
        "terminal.toml"));
    run_to(simulation, 3);
    const Positions v = simulation.state().v;
    EXPECT_NEAR(v.col(2).minCoeff(), -terminal_m_s, 1e-8) << damping;
    EXPECT_NEAR(v.col(2).maxCoeff(), -terminal_m_s, 1e-8) << damping;
  }
}

// A march of as many steps as that would need is not made. At 10^6 1/m gravity is held at 3 mm/s, or at 1 m/s where it
// is 10^5 times as strong.
TEST(Drag, TheStrongestIsBorneInAnyStep) {
  for (const auto& [gravity_m_s2, terminal_m_s] : {std::pair(9.81, std::sqrt(9.81e-6)), std::pair(1e6, 1.0)}) {
    Simulation simulation(parse_scene(
        "quadratic_drag_1_m = 1e6\ngravity_m_s2 = [0, 0, -" + std::to_string(gravity_m_s2) +
            "]\n[time]\nframes_per_s = 0.1\nframes = 2\n[[cloth]]\nsheet = {nx = 2, ny = 2, width_m = 0.5, height_m = "
            "0.5}\ndensity_kg_m2 = 0.2\nstretch_n_m = 1e-3\nvelocity_m_s = [1e3, 0, 0]\n",
        "strong.toml"));
    for (int step = 0; step < 2; ++step) {
      const StepResult result = simulation.step();
      EXPECT_EQ(result.report.status, StepStatus::kSafe) << gravity_m_s2;
      EXPECT_EQ(result.halvings, 0) << gravity_m_s2;
    }
    const Positions v = simulation.state().v;
    EXPECT_LE(v.rowwise().norm().maxCoeff(), 1.01 * terminal_m_s) << gravity_m_s2;
    EXPECT_LE(v.col(2).maxCoeff(), -0.5 * terminal_m_s) << gravity_m_s2;
  }
}

TEST(Drag, AsksForStepsThatTakeHalfOfAVelocityAndNoMoreThanSixtyFour) {
  EXPECT_EQ(steps_for_drag(0, 1), 1);
  EXPECT_EQ(steps_for_drag(15.0 * 20, 1.0 / 30), 10);
  EXPECT_EQ(steps_for_drag(1e15, 1), 64);
}

}  // namespace selvage
