// Cloth that slides over many faces in one step does so as over one: at the default steps, a frame each.
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "sim/scene/scene_reader.h"
#include "sim/step.h"
#include "tests/kernel/with_threads.h"
#include "tests/sim/physics_support.h"

namespace selvage {

using namespace sim;
using sim::testbed::kGravity;

namespace {

constexpr double kSheetThickness = 0.004;

std::string start(double friction, double duration_s, const std::string& solver = "explicit") {
  return "solver = \"" + solver +
         "\"\ngravity_m_s2 = [0, 0, -9.81]\n[time]\nframes_per_s = 30\nduration_s = " + std::to_string(duration_s) +
         "\n[collision]\nthickness_m = 0.004\nfriction_static = " + std::to_string(friction) + "\n";
}

const std::string kMaterial =
    "density_kg_m2 = 0.2\nstretch_n_m = 60\nshear_n_m = 20\nbend_n_m = 0.6\nstabilize_n_m = 0.2\ndamping_ratio = 0.1\n";

/// Edges of 33 mm; `place` says where, and how fast.
std::string sheet(const std::string& place) {
  return "[[cloth]]\nsheet = {nx = 10, ny = 10, width_m = 0.3, height_m = 0.3}\n" + place + "\n" + kMaterial;
}

/// Flat, of cells of 20 mm by 25 mm.
std::string ground() { return "[[body]]\nsheet = {nx = 151, ny = 41, width_m = 3, height_m = 1}\n"; }

struct Slide {
  Simulation simulation;
  Eigen::Index count = 100;  ///< vertices of the sheet, which are the first

  explicit Slide(const std::string& scene) : simulation(parse_scene(scene, "slide.toml")) {}

  void run_to(double end_s) {
    while (simulation.clock().time_s() < end_s - 1e-9) {
      const StepResult step = simulation.step();
      EXPECT_EQ(step.halvings, 0) << simulation.clock().time_s();
      EXPECT_EQ(step.report.first_collisions, 0) << simulation.clock().time_s();
    }
  }
  [[nodiscard]] Positions x() const { return simulation.x().topRows(count); }
  [[nodiscard]] double largest_error_m_s(const Vec3& v) const {
    return (simulation.state().v.topRows(count).leftCols(2).rowwise() - v.head<2>().transpose())
        .rowwise()
        .norm()
        .maxCoeff();
  }
};

}  // namespace

TEST(Sliding, OverSmallFacesWithoutFrictionKeepsTheVelocity) {
  // It slowed to 1.9 m/s and rose when a vertex was held at the border of the face that it had left.
  Slide slide(start(0, 0.3) + sheet("position_m = [-0.9, 0.007, 0.0041]\nvelocity_m_s = [2, 0.3, 0]") + ground());
  slide.run_to(0.3);
  EXPECT_LT(slide.largest_error_m_s({2, 0.3, 0}), 1e-3);
  EXPECT_GT(slide.x().col(2).minCoeff(), 0.99 * kSheetThickness);
  EXPECT_LT(slide.x().col(2).maxCoeff(), 1.02 * kSheetThickness);
}

TEST(Sliding, OverSmallFacesIsSlowedAsFrictionSays) {
  constexpr double kFriction = 0.3, kEnd_s = 0.5;
  Slide slide(start(kFriction, kEnd_s) + sheet("position_m = [-0.9, 0.007, 0.004]\nvelocity_m_s = [2, 0, 0]") +
              ground());
  const double start_m = slide.x().col(0).mean();
  slide.run_to(kEnd_s);
  const double way_m = 2 * kEnd_s - kFriction * kGravity * kEnd_s * kEnd_s / 2;
  EXPECT_NEAR(slide.x().col(0).mean() - start_m, way_m, 0.01 * way_m);
}

TEST(Sliding, UnderTheImplicitSolverIsAsTheLawsSay) {
  constexpr double kFriction = 0.3, kEnd_s = 0.3, kStep_s = 1.0 / 240;
  const std::string moving = sheet("position_m = [-0.9, 0.007, 0.0041]\nvelocity_m_s = [2, 0.3, 0]") + ground();
  Slide freely(start(0, kEnd_s, "implicit") + moving);
  freely.run_to(kEnd_s);
  EXPECT_LT(freely.largest_error_m_s({2, 0.3, 0}), 1e-3);
  EXPECT_GT(freely.x().col(2).minCoeff(), 0.99 * kSheetThickness);
  EXPECT_LT(freely.x().col(2).maxCoeff(), 1.05 * kSheetThickness);
  Slide rubbing(start(kFriction, kEnd_s, "implicit") + moving);
  const Vec3 start_m = rubbing.x().colwise().mean();
  rubbing.run_to(kEnd_s);
  // Backward Euler: each step goes with the velocity at its end.
  const double slowed_m = kFriction * kGravity * (kEnd_s + kStep_s) * kEnd_s / 2;
  const double way_m = std::hypot(2, 0.3) * kEnd_s - slowed_m;
  EXPECT_NEAR((rubbing.x().colwise().mean() - start_m.transpose()).leftCols(2).norm(), way_m, 0.01 * way_m);
}

TEST(Sliding, UnderTheImplicitSolverStaticFrictionHoldsWhatKineticWouldNot) {
  // On a plane that slopes, or moves with the cloth on it, or both. Where cloth was let slide before what it bears was
  // found it slid by 141, 37 and 77 mm.
  struct Case {
    double slope, friction_static, friction_kinetic, speed_m_s;
  };
  for (const Case& c : {Case{0.5, 0.6, 0.3, 0}, Case{0.35, 0.6, 0.3, 0.1}, Case{0.2, 0.6, 0.1, 0.05}}) {
    const double down = kGravity / std::hypot(1, c.slope);
    const std::string speed = std::to_string(c.speed_m_s);
    Slide slide("solver = \"implicit\"\ngravity_m_s2 = [" + std::to_string(c.slope * down) + ", 0, " +
                std::to_string(-down) + "]\n[time]\nframes_per_s = 50\nduration_s = 0.4\nmax_step_s = 0.0025\n" +
                "[collision]\nthickness_m = 0.004\nfriction_static = " + std::to_string(c.friction_static) +
                "\nfriction_kinetic = " + std::to_string(c.friction_kinetic) + "\n" +
                sheet("position_m = [0, 0, 0.004]\nvelocity_m_s = [" + speed + ", 0, 0]") +
                "[[body]]\nsheet = {nx = 2, ny = 2, width_m = 8, height_m = 8}\n[[body.key]]\ntime_s = 0\n"
                "position_m = [0, 0, 0]\n[[body.key]]\ntime_s = 1\nposition_m = [" +
                speed + ", 0, 0]\n");
    const Positions start = slide.x();
    slide.run_to(0.4);
    const double slip_m = (slide.x().col(0) - start.col(0)).mean() - 0.4 * c.speed_m_s;
    EXPECT_NEAR(slip_m, 0, 1e-5) << c.slope << ' ' << c.speed_m_s;
  }
}

TEST(Sliding, UnderTheImplicitSolverCanBeSlowedByKineticFrictionAlone) {
  // It starts to slide: the static cone must not go on to hold it.
  constexpr double kSlope = 0.8, kEnd_s = 0.4, kStep_s = 0.0025;
  const double down = kGravity / std::hypot(1, kSlope);
  Slide slide("solver = \"implicit\"\ngravity_m_s2 = [" + std::to_string(kSlope * down) + ", 0, " +
              std::to_string(-down) +
              "]\n[time]\nframes_per_s = 50\nduration_s = 0.4\nmax_step_s = 0.0025\n[collision]\nthickness_m = 0.004\n"
              "friction_static = 0.6\nfriction_kinetic = 0.2\n" +
              sheet("position_m = [0, 0, 0.004]") + "[[body]]\nsheet = {nx = 2, ny = 2, width_m = 8, height_m = 8}\n");
  const double start_m = slide.x().col(0).mean();
  slide.run_to(kEnd_s);
  const double way_m = (kSlope - 0.2) * down * (kEnd_s + kStep_s) * kEnd_s / 2;
  EXPECT_NEAR(slide.x().col(0).mean() - start_m, way_m, 0.01 * way_m);
}

TEST(Sliding, ARodThatMovesAlongItsAxisTakesNothingAlong) {
  // In steps of 1/30 and 1/240 s; it took the sheet along by 15 and 22 cm.
  for (const char* const solver : {"explicit", "implicit"}) {
    Slide slide(start(0, 0.6, solver) + "[[cloth]]\nsheet = {nx = 8, ny = 16, width_m = 0.15, height_m = 0.3}\n" +
                "position_m = [0, 0, 0.0545]\n" + kMaterial +
                "[[body]]\ncapsule = {end_m = [3, 0, 0], radius_m = 0.05, segments = 24}\nposition_m = [-1, 0, 0]\n"
                "key = [{time_s = 0.1}, {time_s = 0.6, position_m = [-0.5, 0, 0]}]\n");
    slide.count = 128;
    while (slide.simulation.clock().time_s() < 0.6 - 1e-9) static_cast<void>(slide.simulation.step());
    EXPECT_NEAR(slide.x().col(0).mean(), 0, 5e-3) << solver;
  }
}

TEST(Sliding, ABoxThatTurnsBelowTakesNothingAlong) {
  // It was taken along at half of a turn a second.
  Slide slide(
      start(0, 1) + sheet("position_m = [0, 0, 0.0041]") +
      "[[body]]\nbox = {size_m = [1, 1, 0.1], cells = 16}\nposition_m = [0, 0, -0.05]\ninterpolation = \"linear\"\n"
      "key = [{time_s = 0}, {time_s = 1, rotation_deg = [0, 0, 360]}]\n");
  slide.run_to(1);
  EXPECT_LT(slide.largest_error_m_s(Vec3::Zero()), 1e-3);
}

TEST(Sliding, ClothIsPulledOverTheEdgeOfABoxOfAnyCells) {
  // Its springs were pulled out to 1.2 to 7.5 times their length, as cloth that came to the edge was held back by edges
  // of the side below: it lay behind their plane.
  for (const int cells : {1, 3, 8, 16}) {
    Slide slide(
        start(0.3, 0.5) +
        "[[cloth]]\nsheet = {nx = 8, ny = 8, width_m = 1, height_m = 0.8}\nposition_m = [0, 0, 0.005]\n" + kMaterial +
        "pin = [{edge = \"right\", key = [{time_s = 0}, {time_s = 0.1}, {time_s = 0.5, position_m = [0.8, 0, 0]}]}]\n"
        "[[body]]\nposition_m = [0, 0, -0.1]\nbox = {size_m = [0.96, 0.76, 0.2], cells = " +
        std::to_string(cells) + "}\n");
    double largest = 0;
    while (slide.simulation.clock().time_s() < 0.5 - 1e-9) {
      largest = std::max(largest, slide.simulation.step().most_strained.strain);
    }
    EXPECT_LT(largest, 0.15) << cells;
  }
}

TEST(Sliding, OnClothThatLiesOnTheGroundIsAsOnTheGround) {
  // Both fall in the free flight that tells which contacts are pressed: the upper one was let fall through the lower
  // one, thrown back at the end of every step, and lost 0.09 of 1.5 m/s in a second.
  Slide slide(start(0, 0.3) + sheet("position_m = [-0.3, 0.007, 0.0081]\nvelocity_m_s = [1.5, 0, 0]") +
              "[[cloth]]\nname = \"under\"\nsheet = {nx = 31, ny = 16, width_m = 1.2, height_m = 0.6}\n"
              "position_m = [0, 0, 0.0041]\n" +
              kMaterial + "[[body]]\nsheet = {nx = 2, ny = 2, width_m = 8, height_m = 8}\n");
  slide.run_to(0.3);
  EXPECT_LT(slide.largest_error_m_s({1.5, 0, 0}), 0.01);
  EXPECT_GT(slide.x().col(2).minCoeff(), 1.95 * kSheetThickness);
  EXPECT_LT(slide.x().col(2).maxCoeff(), 2.5 * kSheetThickness);
}

// A slope of 0.25 under a friction of 0.4: cloth is held by edges as well as by vertices. While edges remembered
// nothing the upper sheet crept by 0.4 mm a second.
TEST(Sliding, ClothOnClothSticksBelowTheAngleOfFriction) {
  const std::string tilted = "gravity_m_s2 = [2.379, 0, -9.517]\n";
  std::string scene = start(0.4, 3) + sheet("name = \"lower\"\nposition_m = [0, 0, 0.0041]") +
                      sheet("name = \"upper\"\nposition_m = [0.01, 0.007, 0.0082]\nrotation_deg = [0, 0, 7]") +
                      "[[body]]\nsheet = {nx = 2, ny = 2, width_m = 20, height_m = 20}\n";
  scene.replace(scene.find("gravity"), scene.find("[time]") - scene.find("gravity"), tilted);
  Slide slide(scene);
  slide.count = 200;
  slide.run_to(1);
  const Positions lain_down = slide.x();
  slide.run_to(3);
  EXPECT_LT((slide.x() - lain_down).rowwise().norm().maxCoeff(), 5e-5);
}

/// More contacts than one group has (contact_groups.h); they go on to faces that are of other groups.
TEST(Sliding, SameBitsForAnyThreadCount) {
  std::string scene = start(0.1, 0.1) + ground() + sheet("name = \"lower\"\nposition_m = [0, 0, 0.0045]") +
                      sheet("name = \"upper\"\nposition_m = [0.01, 0.02, 0.009]\nvelocity_m_s = [1, 0.3, 0]");
  const auto replace = [&](const std::string& from, const std::string& to) {
    scene.replace(scene.find(from), from.size(), to);
  };
  for (int sheet = 0; sheet < 2; ++sheet) replace("nx = 10, ny = 10", "nx = 32, ny = 32");
  replace("friction_static", "contact_sweeps = 2\nfriction_static");
  Positions reference;
  for (const int threads : {1, 2, 4}) {
    selvage::testing::with_threads(threads, [&] {
      Simulation simulation(parse_scene(scene, "slide.toml"));
      std::int64_t repulsions = 0;
      while (simulation.clock().frame() < 3) repulsions = simulation.step().report.repulsions;
      EXPECT_GT(repulsions, 1024);
      if (threads == 1) reference = simulation.x();
      EXPECT_EQ(simulation.x(), reference) << threads << " threads";
    });
  }
}

}  // namespace selvage
