#include "sim/contact/local_proximities.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "tests/sim/step_scene.h"

namespace selvage::sim::testbed {
namespace {

constexpr double kThickness = 0.025, kReach = 2 * kThickness;

std::vector<PairProximity> near_pairs(const Mesh& mesh, const Positions& V) {
  BoxHierarchy hierarchy(mesh);
  return find_proximities(mesh, hierarchy, V, kReach);
}

}  // namespace

TEST(LocalProximities, AboveFlatGroundPointUpwardsAlone) {
  // A sheet slides over a finer ground, lower than the reach: its vertices and edges pass the edges of the ground.
  StepScene scene;
  scene.add(make_sheet(9, 9, 0.4, 0.4), Vec3::Zero());
  scene.add(make_sheet(4, 4, 0.2, 0.2), Vec3(0.013, 0.017, 0.02));
  const Mesh mesh = scene.mesh();
  const auto is_slanted = [](const PairProximity& pair) {
    // Pairs within one sheet lie in its plane.
    return std::abs(pair.proximity.normal.z()) > 1e-9 && std::abs(pair.proximity.normal.z()) < 1 - 1e-9;
  };
  const std::vector<PairProximity> all = near_pairs(mesh, scene.V_t0),
                                   local = local_proximities(mesh, VertexFaces(mesh), scene.V_t0, all, kThickness);
  EXPECT_GT(std::ranges::count_if(all, is_slanted), 100);
  EXPECT_EQ(std::ranges::count_if(local, is_slanted), 0);
  // Every vertex of the upper sheet still stands on the ground.
  for (VertexId v = 81; v < 97; ++v) {
    EXPECT_TRUE(std::ranges::any_of(local, [&](const PairProximity& pair) {
      return pair.kind == PairKind::kVf && pair.first == v && std::abs(pair.proximity.distance - 0.02) < 1e-12;
    })) << v;
  }
}

TEST(LocalProximities, HoldEveryVertexOfASheetThatLiesALittleTiltedOnAnother) {
  // Its corners and borders stand over those of the sheet below, shifted by less than a hundredth of an edge.
  StepScene scene;
  scene.add(make_sheet(4, 4, 0.3, 0.3), Vec3::Zero());
  scene.add(make_sheet(4, 4, 0.3, 0.3), Vec3(0.0003, -0.0002, 0.02));
  for (Eigen::Index v = 16; v < 32; ++v) scene.V_t0(v, 2) += 0.01 * scene.V_t0(v, 0) + 0.02 * scene.V_t0(v, 1);
  const Mesh mesh = scene.mesh();
  const std::vector<PairProximity> local =
      local_proximities(mesh, VertexFaces(mesh), scene.V_t0, near_pairs(mesh, scene.V_t0), kThickness);
  for (VertexId v = 0; v < 32; ++v) {
    EXPECT_TRUE(std::ranges::any_of(local, [&](const PairProximity& pair) {
      const auto at = std::ranges::find(pair.vertices, v) - pair.vertices.begin();
      return at < 4 && std::abs(pair.proximity.normal.z()) > 0.9 &&
             pair.proximity.weights[static_cast<std::size_t>(at)] > 0.7;
    })) << v;
  }
}

TEST(LocalProximities, KeepsRidgesThatAreContacts) {
  // A small triangle's corner beside an edge at which a roof bends away: no face is nearer than the edge.
  StepScene scene;
  Shape roof, tip;
  roof.x.resize(4, 3);
  roof.x << 0, -1, 0, 0, 1, 0, 1, 0, -1, -1, 0, -1;
  roof.triangles = {{0, 2, 1}, {0, 1, 3}};
  tip.x.resize(3, 3);
  tip.x << 0, 0, 0.01, -0.3, 0.2, 0.5, 0.3, 0.2, 0.5;
  tip.triangles = {{0, 1, 2}};
  scene.add(roof, Vec3::Zero());
  scene.add(tip, Vec3::Zero());
  const Mesh mesh = scene.mesh();
  const std::vector<PairProximity> local =
      local_proximities(mesh, VertexFaces(mesh), scene.V_t0, near_pairs(mesh, scene.V_t0), kThickness);
  EXPECT_TRUE(std::ranges::any_of(local, [](const PairProximity& pair) {
    return pair.kind == PairKind::kVf && pair.first == 4 && std::abs(pair.proximity.distance - 0.01) < 1e-12;
  }));
}

TEST(LocalProximities, KeepsTheNearestPairAndWhatIsInsideAFace) {
  std::mt19937_64 engine(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int round = 0; round < 50; ++round) {
    StepScene scene;
    scene.add(make_sheet(4, 4, 0.1, 0.1), Vec3::Zero());
    scene.add(make_sheet(4, 4, 0.1, 0.1), Vec3(0.01, 0.01, 0.02));
    for (Eigen::Index i = 0; i < scene.V_t0.size(); ++i) scene.V_t0.data()[i] += 0.02 * unit(engine);
    const Mesh mesh = scene.mesh();
    const std::vector<PairProximity> all = near_pairs(mesh, scene.V_t0),
                                     local = local_proximities(mesh, VertexFaces(mesh), scene.V_t0, all, kThickness);
    ASSERT_LT(local.size(), all.size());
    const auto nearer = [](const PairProximity& a, const PairProximity& b) {
      return a.proximity.distance < b.proximity.distance;
    };
    EXPECT_EQ(std::ranges::min_element(local, nearer)->proximity.distance,
              std::ranges::min_element(all, nearer)->proximity.distance);
    const auto is_inside_a_face = [](const PairProximity& pair) {
      return pair.kind == PairKind::kVf &&
             std::ranges::find(pair.proximity.weights, 0.0) == pair.proximity.weights.end();
    };
    EXPECT_EQ(std::ranges::count_if(local, is_inside_a_face), std::ranges::count_if(all, is_inside_a_face));
  }
}

}  // namespace selvage::sim::testbed
