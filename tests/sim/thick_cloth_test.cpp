// Cloth that is thicker than its edges are long: most of its features are nearer at rest than it is thick.
#include <algorithm>
#include <numbers>
#include <string>
#include <tuple>

#include <gtest/gtest.h>

#include "kernel/collisions.h"
#include "sim/scene/scene_reader.h"
#include "sim/step.h"

namespace selvage::sim {
namespace {

/// A square sheet of 9 x 9 vertices, 10 mm apart.
std::string sheet(const std::string& more = "") {
  return "[[cloth]]\nsheet = {nx = 9, ny = 9, width_m = 0.08, height_m = 0.08}\ndensity_kg_m2 = 0.2\nstretch_n_m = 60\n"
         "shear_n_m = 20\nbend_n_m = 0.6\nstabilize_n_m = 0.2\ndamping_ratio = 0.1\n" +
         more;
}
constexpr double kEdge_m = 0.01;
constexpr Eigen::Index kVertices = 9 * 9;

Simulation make(const std::string& top, double duration_s, double thickness_m, const std::string& parts) {
  return Simulation(parse_scene(
      top + "[time]\nframes_per_s = 30\nduration_s = " + std::to_string(duration_s) +
          "\n[collision]\nfriction_static = 0.5\nthickness_m = " + std::to_string(thickness_m) + "\n" + parts,
      "thick.toml"));
}

struct Strains {
  double shortest = 0, longest = 0;
};
/// Of the springs along and across the squares, relative to their rest lengths.
Strains strains(const Simulation& simulation) {
  Strains result;
  for (const Spring& spring : simulation.world().springs.springs()) {
    if (spring.kind == SpringKind::kBending) continue;
    const double length_m = (simulation.x().row(spring.b) - simulation.x().row(spring.a)).norm();
    result.shortest = std::min(result.shortest, length_m / spring.rest_length_m - 1);
    result.longest = std::max(result.longest, length_m / spring.rest_length_m - 1);
  }
  return result;
}

}  // namespace

TEST(ThickCloth, KeepsItsShapeWhereNothingActsOnIt) {
  for (const std::string solver : {"explicit", "implicit"}) {
    for (const double edges : {0.8, 1.0, 2.0, 3.0}) {
      // Its own tolerance counts as well: of what rests nearer than that, nothing is pushed apart.
      Simulation simulation = make("solver = \"" + solver + "\"\n", 0.3, edges * kEdge_m,
                                   sheet("position_m = [0.1, 0.2, 0.3]\nrotation_deg = [20, 30, 40]\ntolerance_m = " +
                                         std::to_string(0.8 * edges * kEdge_m) + "\n"));
      while (simulation.clock().time_s() < 0.3 - 1e-9) simulation.step();
      const Strains after = strains(simulation);
      EXPECT_LT(after.longest, 1e-6) << solver << ", " << edges << " edges";
      EXPECT_GT(after.shortest, -1e-6) << solver << ", " << edges << " edges";
      EXPECT_LT(simulation.state().v.cwiseAbs().maxCoeff(), 1e-6) << solver << ", " << edges << " edges";
    }
  }
}

/// Its pairs at rest are at their limit: whatever a solver leaves presses them, with friction.
TEST(ThickCloth, KeepsItsVelocityWhereNothingActsOnIt) {
  for (const std::string solver : {"explicit", "implicit"}) {
    Simulation simulation = make("solver = \"" + solver + "\"\n", 0.1, 0.1,
                                 "[[cloth]]\nsheet = {nx = 6, ny = 6, width_m = 0.25, height_m = 0.25}\n"
                                 "density_kg_m2 = 0.2\nstretch_n_m = 1e5\nrotation_deg = [20, 30, 40]\n"
                                 "velocity_m_s = [1, 2, 3]\n");
    while (simulation.clock().time_s() < 0.1 - 1e-9) {
      EXPECT_EQ(simulation.step().dynamics.unconverged, 0) << solver;
    }
    const Eigen::RowVector3d mean_m_s = simulation.state().v.colwise().mean(), thrown_m_s(1, 2, 3);
    EXPECT_LT((mean_m_s - thrown_m_s).norm(), 1e-9) << solver;
  }
}

/// A pair that turns is no nearer for it: seen along where it lay before, its own pairs pressed, and a sheet that spun
/// with nothing to touch had 4.3 times its energy within a second.
TEST(ThickCloth, SpinsWithTheEnergyThatItHas) {
  std::string pin = "[[cloth.pin]]\nvertices = [";
  for (int v = 0; v < 49; ++v) pin += (v > 0 ? ", " : "") + std::to_string(v);
  pin += "]\nrelease_s = 0.1\ninterpolation = \"linear\"\nkey = [{time_s = 0}, {time_s = 0.1, rotation_deg = [0, 0, ";
  for (const double speed_rad_s : {6.0, 20.0}) {
    const double turned_deg = 0.1 * speed_rad_s * 180 / std::numbers::pi;
    Simulation simulation =
        make("", 0.8, 0.15,
             "[[cloth]]\nsheet = {nx = 7, ny = 7, width_m = 0.6, height_m = 0.6}\ndensity_kg_m2 = 0.2\n"
             "stretch_n_m = 2000\nshear_n_m = 600\nbend_n_m = 600\ndamping_ratio = 0.1\n" +
                 pin + std::to_string(turned_deg) + "]}]\n");
    double first = 0, most = 0;
    while (simulation.clock().time_s() < 0.8 - 1e-9) {
      simulation.step();
      const double twice_j_kg = simulation.state().v.squaredNorm() / 49;
      if (simulation.clock().time_s() < 0.1 + 1e-9) first = twice_j_kg;
      most = std::max(most, twice_j_kg);
    }
    ASSERT_GT(first, 0);
    EXPECT_LT(most, 1.01 * first) << speed_rad_s;
    EXPECT_GT(simulation.state().v.squaredNorm() / 49, 0.6 * first) << speed_rad_s << ": damping takes some";
  }
}

TEST(ThickCloth, HasThePairsOfEveryClothInTheNumbersOfTheWorld) {
  const std::string time = "[time]\nframes = 1\n[collision]\n";
  const std::string parts = sheet("copies = 3\ncopy_offset_m = [0.5, 0, 0]\n") +
                            sheet("name = \"thin\"\nposition_m = [0, 1, 0]\nthickness_m = 0.001\n") +
                            "[[body]]\nbox = {size_m = [0.01, 0.01, 0.01]}\nposition_m = [0, 0, 1]\n";
  const World world = build_world(parse_scene(time + "thickness_m = 0.025\n" + parts, "thick.toml"));
  std::vector<RestPair> expected = find_rest_pairs(world.mesh, world.x_t0, 0.025);
  std::erase_if(expected, [&](const RestPair& pair) {
    const auto v = pair_vertices(world.mesh, pair.kind, pair.first, pair.second);
    return *std::ranges::max_element(v) >= 3 * kVertices;  // the thin sheet, the box
  });
  std::vector<RestPair> pairs = world.contacts.rest_pairs;
  std::ranges::sort(pairs, {}, [](const RestPair& p) { return std::tuple(p.kind, p.first, p.second); });
  ASSERT_EQ(pairs.size(), expected.size());
  EXPECT_GT(pairs.size(), 3000U);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    ASSERT_EQ(std::tuple(pairs[k].kind, pairs[k].first, pairs[k].second),
              std::tuple(expected[k].kind, expected[k].first, expected[k].second));
    ASSERT_NEAR(pairs[k].distance_m, expected[k].distance_m, 1e-12);
  }
  EXPECT_TRUE(
      build_world(parse_scene(time + "thickness_m = 0.007\n" + parts, "thick.toml")).contacts.rest_pairs.empty());
  EXPECT_TRUE(build_world(parse_scene(time + "thickness_m = 0.025\nrepulsion = false\n" + parts, "thick.toml"))
                  .contacts.rest_pairs.empty());
}

TEST(ThickCloth, DrapesSlowlyAndUnstretched) {
  // At its whole thickness it was blown up: 1400 m/s, and springs of 780 times their length.
  Simulation simulation =
      make("gravity_m_s2 = [0, 0, -9.81]\ndrag_1_s = 1\n", 0.3, 2 * kEdge_m,
           sheet("position_m = [0, 0, 0.05]\n") + "[[body]]\nsphere = {radius_m = 0.025, subdivisions = 2}\n");
  double fastest_m_s = 0;
  Strains most;
  while (simulation.clock().time_s() < 0.3 - 1e-9) {
    simulation.step();
    fastest_m_s = std::max(fastest_m_s, simulation.state().v.rowwise().norm().maxCoeff());
    const Strains now = strains(simulation);
    most.longest = std::max(most.longest, now.longest);
    most.shortest = std::min(most.shortest, now.shortest);
  }
  EXPECT_LT(fastest_m_s, 2) << "a fall of 5 cm ends at 1 m/s";
  EXPECT_LT(most.longest, 0.15);
  EXPECT_GT(most.shortest, -0.15);
  const auto height_m = simulation.x().topRows(kVertices).col(2);
  EXPECT_GT(height_m.maxCoeff() - height_m.minCoeff(), 0.02) << "it hangs down";
}

TEST(ThickCloth, RepelsOtherClothAtItsWholeThickness) {
  const double thickness_m = 2 * kEdge_m;
  Simulation simulation = make("gravity_m_s2 = [0, 0, -9.81]\ndrag_1_s = 2\n", 0.3, thickness_m,
                               sheet("name = \"upper\"\nposition_m = [0.003, 0.002, 0.045]\n") +
                                   sheet("name = \"lower\"\nposition_m = [0, 0, 0.021]\n") +
                                   "[[body]]\nsheet = {nx = 2, ny = 2, width_m = 4, height_m = 4}\n");
  while (simulation.clock().time_s() < 0.3 - 1e-9) simulation.step();
  EXPECT_LT(strains(simulation).longest, 0.1);
  const auto height_m = [&](Eigen::Index begin) { return simulation.x().middleRows(begin, kVertices).col(2).mean(); };
  EXPECT_NEAR(height_m(kVertices), thickness_m, 0.05 * thickness_m);
  EXPECT_NEAR(height_m(0), 2 * thickness_m, 0.05 * thickness_m);
}

}  // namespace selvage::sim
