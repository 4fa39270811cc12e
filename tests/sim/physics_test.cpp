// The whole simulator against known answers.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "sim/dynamics/central_differences.h"
#include "sim/scene/scene_reader.h"
#include "sim/step.h"
#include "tests/sim/physics_support.h"

namespace selvage {

using namespace sim;
using namespace sim::testbed;

namespace {

/// A cloth of which every vertex is pinned.
std::string held_sheet() {
  std::string all = "0";
  for (int i = 1; i < 17 * 9; ++i) all += ", " + std::to_string(i);
  return "[[cloth]]\nname = \"lower\"\nsheet = {nx = 17, ny = 9, width_m = 0.8, height_m = 0.4}\nposition_m = [0.2, 0, "
         "0]\n"
         "density_kg_m2 = 0.2\nstretch_n_m = 20\n[[cloth.pin]]\nvertices = [" +
         all + "]\n";
}

struct Momenta {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
  double linear_scale = 0, angular_scale = 0;
};
Momenta momenta(const Simulation& simulation) {
  Momenta sum;
  const SimulationState state = simulation.state();
  for (Eigen::Index i = 0; i < state.x.rows(); ++i) {
    const Vec3 x = state.x.row(i),
               p = state.v.row(i).transpose() / simulation.world().inverse_mass[static_cast<std::size_t>(i)];
    sum.linear += p;
    sum.angular += x.cross(p);
    sum.linear_scale += p.norm();
    sum.angular_scale += x.norm() * p.norm();
  }
  return sum;
}

}  // namespace

TEST(Physics, PendulumSwingsWithItsPeriod) {
  // T = 2 pi sqrt(l / g) (1 + a^2 / 16) to fourth order in the amplitude a; the spring is 0.1 % longer under the
  // weight.
  const double mass = 0.01, stiffness = 98.1, amplitude = 0.1;
  const SpringSystem spring({Spring{0, 1, SpringKind::kStructural, 1, stiffness, 0.05}}, 2);
  const std::vector<double> inverse_mass = {0, 1 / mass};
  CentralDifferencesOptions options;
  options.fields.gravity_m_s2 = {0, 0, -kGravity};
  options.strain = {.strain = 0, .strain_rate = 0};
  options.step_s = 1e-3;
  CentralDifferences dynamics(spring, options);
  const double length = 1 + mass * kGravity / stiffness;
  Motion motion{Positions::Zero(2, 3), Positions::Zero(2, 3)};
  motion.x.row(1) << length * std::sin(amplitude), 0, -length * std::cos(amplitude);
  const Positions held = Positions::Zero(2, 3);
  double time_s = 0, crossing_s = 0;
  int crossings = 0;
  while (crossings < 9) {
    const double before = motion.x(1, 0);
    dynamics.advance(motion, held, inverse_mass, 1e-3);
    time_s += 1e-3;
    if (before * motion.x(1, 0) > 0) continue;
    ++crossings;
    const double at = time_s - 1e-3 * motion.x(1, 0) / (motion.x(1, 0) - before);
    if (crossings == 1) crossing_s = at;
    if (crossings == 9) crossing_s = at - crossing_s;  // four periods
  }
  const double period = 2 * std::numbers::pi * std::sqrt(length / kGravity) * (1 + amplitude * amplitude / 16);
  EXPECT_NEAR(crossing_s / 4, period, 5e-4 * period);
}

TEST(Physics, HangingStripIsTheDiscreteCatenary) {
  // n links of rest length l between equal masses; both ends held at the same height. In each link the horizontal force
  // is H and the vertical one grows by the weight of a mass; by symmetry H alone is unknown.
  constexpr int kLinks = 20;
  const double rest = 0.06, stiffness = 40, mass = 2e-3, span = 0.9;
  const auto half_span = [&](double H) {
    double width = 0;
    for (int i = 0; i < kLinks / 2; ++i) {
      const double V = mass * kGravity * (i + 0.5), T = std::hypot(H, V);
      width += rest * (1 + T / (stiffness * rest)) * H / T;
    }
    return width;
  };
  double lower = 0, upper = 10;
  for (int i = 0; i < 200; ++i) {
    const double middle = (lower + upper) / 2;
    (half_span(middle) < span / 2 ? lower : upper) = middle;
  }
  std::vector<double> depth(kLinks / 2 + 1, 0);  // below the lowest node, counted from it
  for (int i = 0; i < kLinks / 2; ++i) {
    const double V = mass * kGravity * (i + 0.5), T = std::hypot(lower, V);
    depth[static_cast<std::size_t>(i) + 1] = depth[static_cast<std::size_t>(i)] + (rest / T + 1 / stiffness) * V;
  }

  std::vector<Spring> links;
  for (VertexId i = 0; i < kLinks; ++i) links.push_back({i, i + 1, SpringKind::kStructural, rest, stiffness, 0.05});
  const SpringSystem springs(links, kLinks + 1);
  std::vector<double> inverse_mass(kLinks + 1, 1 / mass);
  inverse_mass.front() = inverse_mass.back() = 0;
  CentralDifferencesOptions options;
  options.fields.gravity_m_s2 = {0, 0, -kGravity};
  options.fields.drag_1_s = 4;
  options.strain = {.strain = 0, .strain_rate = 0};
  options.step_s = 0.9 * stable_step_s(springs, inverse_mass);
  Motion motion{Positions::Zero(kLinks + 1, 3), Positions::Zero(kLinks + 1, 3)};
  for (VertexId i = 0; i <= kLinks; ++i) motion.x(i, 0) = span * (double(i) / kLinks - 0.5);
  const Positions held = motion.x;
  CentralDifferences(springs, options).advance(motion, held, inverse_mass, 12);
  for (int i = 0; i <= kLinks / 2; ++i) {
    EXPECT_NEAR(motion.x(kLinks / 2 + i, 2) - motion.x(kLinks / 2, 2), depth[static_cast<std::size_t>(i)], 1e-8) << i;
  }
}

TEST(Physics, SheetSticksBelowTheAngleOfFrictionAndSlidesAboveItAsTheLawSays) {
  // It starts with a push of 0.2 m/s. The mean speed over the last frame, because the velocity at the end of a step
  // already has half a step of gravity, and not yet of friction.
  constexpr double kSlope = 0.4, kPush = 0.2, kLast = 0.28, kEnd = 0.3;
  for (const auto& [on_cloth, solver] :
       {std::pair(false, "explicit"), {true, "explicit"}, {false, "implicit"}, {true, "implicit"}}) {
    const std::string name = std::string(on_cloth ? "cloth on cloth, " : "cloth on a plane, ") + solver;
    const auto speed = [on_cloth = on_cloth, solver = solver](double friction) {
      const std::string lower = on_cloth ? held_sheet() : plane();
      Simulation simulation(parse_scene("solver = \"" + std::string(solver) + "\"\n" + tilted_gravity(kSlope) +
                                            "[time]\nframes_per_s = 50\nduration_s = 0.3\nmax_step_s = 0.0025\n"
                                            "[collision]\nthickness_m = 0.002\nfriction_static = " +
                                            std::to_string(friction) + "\n" + sheet("upper", 0.0015, 0) + lower,
                                        "slope.toml"));
      const auto run_to = [&](double end_s) {
        while (simulation.clock().time_s() < end_s - 1e-9) simulation.step();
        return mean(simulation.x(), 0, 49).x();
      };
      const double before = run_to(kLast);
      return (run_to(kEnd) - before) / (kEnd - kLast);
    };
    EXPECT_NEAR(speed(0.6), 0, 5e-4) << name;
    const double expected = kPush + (kSlope - 0.2) * kGravity / std::hypot(1, kSlope) * (kLast + kEnd) / 2;
    EXPECT_NEAR(speed(0.2), expected, 0.03 * expected) << name;
  }
}

// What begins to slide by mistake would go on sliding: kinetic friction is far below the slope.
TEST(Physics, SheetSticksWhereStaticFrictionHoldsItAndKineticWouldNot) {
  constexpr double kDown = 4.1, kInto = 8.9;  // m/s^2, along and into the plane
  const struct {
    const char* solver;
    int cells;  ///< vertices along a side of the plane
    double margin;
  } kCases[] = {{"explicit", 2, 1.02}, {"explicit", 8, 1.2}, {"implicit", 2, 1.15}, {"implicit", 8, 1.15}};
  for (const auto& [solver, cells, margin] : kCases) {
    for (const int frames_per_s : {24, 30, 60}) {
      Simulation simulation(parse_scene(
          fmt::format("solver = \"{}\"\ngravity_m_s2 = [{}, 0, {}]\n[time]\nframes_per_s = {}\nduration_s = 0.25\n"
                      "[collision]\nthickness_m = 0.003\nfriction_static = {}\nfriction_kinetic = 0.05\n"
                      "[[cloth]]\nsheet = {{nx = 12, ny = 12, width_m = 0.3, height_m = 0.3}}\nposition_m = [0.1, 0, "
                      "0.003]\ndensity_kg_m2 = 0.2\nstretch_n_m = 400\nshear_n_m = 100\nbend_n_m = 1\n"
                      "damping_ratio = 0.1\n[[body]]\nsheet = {{nx = {}, ny = {}, width_m = 2.03, height_m = 2.01}}\n",
                      solver, kDown, -kInto, frames_per_s, margin * kDown / kInto, cells, cells),
          "slope.toml"));
      const double start = mean(simulation.x(), 0, 144).x();
      while (simulation.clock().frame() < simulation.scene().time.frame_count) simulation.step();
      EXPECT_NEAR(mean(simulation.x(), 0, 144).x(), start, 1e-8)
          << solver << ", " << cells << " vertices a side, " << frames_per_s << " frames a second";
    }
  }
}

namespace {

/// A square sheet beside others, at the height z.
std::string small_sheet(const std::string& name, double y, double z, double velocity_x, const std::string& more) {
  return "[[cloth]]\nname = \"" + name +
         "\"\nsheet = {nx = 4, ny = 4, width_m = 0.06, height_m = 0.06}\nposition_m = [0.004, " + std::to_string(y) +
         ", " + std::to_string(z) + "]\nrotation_deg = [0, 0, 10]\nvelocity_m_s = [" + std::to_string(velocity_x) +
         ", 0, 0]\ndensity_kg_m2 = 0.2\nstretch_n_m = 20\nshear_n_m = 10\n" + more;
}

Positions run(const std::string& text, double end_s) {
  Simulation simulation(parse_scene(text, "parts.toml"));
  return run_to(simulation, end_s);
}

}  // namespace

TEST(Physics, OnOneSlopeOneClothSticksAndAnotherSlides) {
  // Geometric means: 0.9 and 0.4 give 0.6, which holds on a slope of 0.4; 0.1 and 0.4 give 0.2, which does not.
  constexpr double kSlope = 0.4, kPush = 0.2, kEnd = 0.3;
  const std::string text = tilted_gravity(kSlope) +
                           "[time]\nframes_per_s = 50\nduration_s = 0.3\nmax_step_s = 0.0025\n"
                           "[collision]\nthickness_m = 0.002\n" +
                           small_sheet("rough", -0.1, 0.0015, kPush, "friction_static = 0.9\n") +
                           small_sheet("smooth", 0.1, 0.0015, kPush, "friction_static = 0.1\n") + plane() +
                           "friction_static = 0.4\n";
  const Positions before = run(text, kEnd - 0.02), after = run(text, kEnd);
  const auto speed = [&](VertexId begin) {
    return (mean(after, begin, begin + 16).x() - mean(before, begin, begin + 16).x()) / 0.02;
  };
  EXPECT_NEAR(speed(0), 0, 5e-4) << "rough";
  const double expected = kPush + (kSlope - 0.2) * kGravity / std::hypot(1, kSlope) * (kEnd - 0.01);
  EXPECT_NEAR(speed(16), expected, 0.03 * expected) << "smooth";
}

TEST(Physics, EveryClothRestsAtItsOwnDistance) {
  const Positions rest =
      run(tilted_gravity(0) + "drag_1_s = 2\n[time]\nframes_per_s = 50\nduration_s = 0.5\nmax_step_s = 0.0025\n" +
              small_sheet("thin", -0.1, 0.005, 0, "thickness_m = 0.001\n") +
              small_sheet("thick", 0.1, 0.005, 0, "thickness_m = 0.004\n") + plane() + "thickness_m = 0.002\n",
          0.5);
  // One step of gravity is 6e-5 m, which is what a resting sheet dips in and comes back by.
  EXPECT_NEAR(mean(rest, 0, 16).z(), 0.0015, 1e-4);
  EXPECT_NEAR(mean(rest, 16, 32).z(), 0.003, 1e-4);
}

TEST(Physics, AStepNamesWhatIsNearerThanTheToleranceOfItsParts) {
  std::string all = "0";  // but for one vertex: a sheet that a script holds altogether is a body
  for (int i = 1; i < 15; ++i) all += ", " + std::to_string(i);
  const std::string pin = "[[cloth.pin]]\nvertices = [" + all + "]\n";
  const auto named = [&](const std::string& of_left, const std::string& of_right, const std::string& of_plane) {
    Simulation simulation(parse_scene("[time]\nframes = 1\n" + small_sheet("left", -0.1, 0.0005, 0, of_left + pin) +
                                          small_sheet("right", 0.1, 0.0005, 0, of_right + pin) + plane() + of_plane,
                                      "parts.toml"));
    std::array<std::int64_t, 2> count{};
    const StepResult step = simulation.step();
    for (const Collision& pair : step.report.below_tolerance) {
      const auto v = pair_vertices(simulation.world().mesh, pair.kind, pair.first, pair.second);
      ++count[*std::ranges::min_element(v) < 16 ? 0 : 1];
    }
    return count;
  };
  const std::string high = "tolerance_m = 0.0006\n";
  EXPECT_EQ(named("", "", ""), (std::array<std::int64_t, 2>{0, 0}));
  EXPECT_EQ(named(high, "", "")[0], 15) << "all that are pinned; the free one is pushed away";
  EXPECT_EQ(named(high, "", "")[1], 0);
  EXPECT_EQ(named("", "", high)[0], named("", "", high)[1]);
  EXPECT_EQ(named("", "", high)[1], 15);
}

TEST(Physics, PartsThatAreAllAlikeHaveTheBitsOfOneValueForTheScene) {
  const std::string values =
      "thickness_m = 0.003\ntolerance_m = 0.00001\nfriction_static = 0.5\nfriction_kinetic = 0.3\n";
  const auto bits = [&](const std::string& of_scene, const std::string& of_part) {
    return run(tilted_gravity(0.4) + "[time]\nframes_per_s = 50\nduration_s = 0.1\n[collision]\n" + of_scene +
                   small_sheet("one", 0, 0.002, 0.2, of_part) + small_sheet("two", 0.02, 0.004, 0, of_part) + plane() +
                   of_part,
               0.1);
  };
  const Positions by_scene = bits(values, "");
  EXPECT_EQ(bits("", values), by_scene);
  EXPECT_EQ(bits(values, values), by_scene);
  EXPECT_NE(bits("", ""), by_scene) << "they matter";
}

TEST(Physics, CollidingSheetsKeepBothMomentaInEveryStep) {
  // Steps no longer than one of the dynamics: in longer ones the springs turn between the impulses of the dynamics and
  // those of contact, which moves some 1e-5 of the angular momentum in a step of 5 ms.
  for (const std::string more : {"", "stabilize_n_m = 0.2\n", "stabilize_n_m = 5\n"}) {
    Simulation simulation(
        parse_scene("[time]\nframes_per_s = 50\nduration_s = 0.2\nmax_step_s = 0.0008\n[collision]\nthickness_m = "
                    "0.003\nfriction_static = 0.5\n" +
                        sheet("lower", 0, 0.4, more) + sheet("upper", 0.02, -0.7, more),
                    "closed.toml"));
    std::int64_t contacts = 0;
    while (simulation.clock().time_s() < 0.2 - 1e-9) {
      const Momenta before = momenta(simulation);
      const StepResult step = simulation.step();
      ASSERT_EQ(step.report.zone_rounds, 0);  // a zone's chord keeps angular momentum to sin(angle) / angle only
      contacts += step.report.repulsions;
      const Momenta after = momenta(simulation);
      EXPECT_LE((after.linear - before.linear).norm(), 1e-12 * before.linear_scale) << more;
      EXPECT_LE((after.angular - before.angular).norm(), 1e-12 * before.angular_scale) << more;
    }
    EXPECT_GT(contacts, 150) << "they have met" << more;
  }
}

TEST(Physics, SheetComesToRestAndStays) {
  for (const std::string solver : {"explicit", "implicit"}) {
    Simulation simulation(
        parse_scene("solver = \"" + solver + "\"\n" + tilted_gravity(0.1) +
                        "drag_1_s = 2\n[time]\nframes_per_s = 50\nduration_s = 1.6\n"
                        "max_step_s = 0.005\n[collision]\nthickness_m = 0.002\nfriction_static = 0.5\n" +
                        sheet("sheet", 0.01, 0) + plane(),
                    "rest.toml"));
    const Positions early = run_to(simulation, 1.4), late = run_to(simulation, 1.6);
    EXPECT_LT((late - early).topRows(49).rowwise().norm().maxCoeff() / 0.2, 1e-6) << "m/s, " << solver;
  }
}

TEST(Physics, ClothThatHangsByTwoCornersIsHeldByItsLimit) {
  Simulation simulation(
      parse_scene("gravity_m_s2 = [0, 0, -9.81]\ndrag_1_s = 0.3\n[time]\nframes_per_s = 30\nduration_s = 1.5\n"
                  "[collision]\nthickness_m = 0.003\n"
                  "[[cloth]]\nsheet = {nx = 40, ny = 40, width_m = 1, height_m = 1}\ndensity_kg_m2 = 0.2\n"
                  "stretch_n_m = 60\nshear_n_m = 20\nbend_n_m = 0.6\ndamping_ratio = 0.1\n"
                  "[[cloth.pin]]\nvertices = [0, 39]\n",
                  "hang.toml"));
  double largest = 0;
  while (simulation.clock().frame() < simulation.scene().time.frame_count) {
    // 0.2. By two rounds of Jacobi, which pass a load on by two springs a step, 0.93.
    const double strain = simulation.step().most_strained.strain;
    EXPECT_LT(strain, 0.25) << simulation.clock().time_s() << " s";
    largest = std::max(largest, strain);
  }
  EXPECT_GT(largest, simulation.scene().strain.strain) << "the load reaches the limit";
}

}  // namespace selvage
