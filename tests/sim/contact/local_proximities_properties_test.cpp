// Which pairs are contacts, against a plain reading of the header: every pair is held against every other.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

#include "sim/contact/local_proximities.h"
#include "tests/property.h"
#include "tests/sim/mechanics.h"
#include "tests/sim/step_scene.h"

namespace selvage::sim::testbed {
namespace {

using selvage::testing::check_property;

using Feature = std::vector<VertexId>;  ///< its vertices

bool holds(const Feature& feature, VertexId vertex) { return std::ranges::find(feature, vertex) != feature.end(); }
bool holds(const Feature& feature, const Feature& all) {
  return std::ranges::all_of(all, [&](VertexId vertex) { return holds(feature, vertex); });
}

template <std::size_t N>
Feature feature_of(const std::array<VertexId, N>& vertices) {
  return {vertices.begin(), vertices.end()};
}

struct Pair {
  PairKind kind;
  Feature first, second;  ///< vertex and face, or edge and edge
  Proximity proximity;
};

Pair make_pair(const Mesh& mesh, const PairProximity& pair) {
  const auto i = static_cast<std::size_t>(pair.first), j = static_cast<std::size_t>(pair.second);
  if (pair.kind == PairKind::kVf) return {pair.kind, {pair.first}, feature_of(mesh.faces[j]), pair.proximity};
  return {pair.kind, feature_of(mesh.edges[i]), feature_of(mesh.edges[j]), pair.proximity};
}

constexpr double kSpacing = 0x1p-3, kLayerThickness = kSpacing / 2;

/// Which of the header's rules leaves a pair out.
enum Rule : std::size_t { kByFace, kByEdge, kByEnd, kByParallelEnd, kRuleCount };
using Rules = std::array<bool, kRuleCount>;

/// From the vertex, where it is an end of the edge, to the edge's nearest point.
double distance_along(const Feature& edge, double weight_0, double weight_1, VertexId vertex, const Positions& V) {
  return (vertex == edge[0] ? weight_1 : weight_0) * (V.row(edge[1]) - V.row(edge[0])).norm();
}

void hold_vf_against(const Pair& pair, const Pair& other, const Positions& V, Rules& rules) {
  Feature nearest;  // of the face: an edge or a corner
  for (std::size_t k = 0; k < 3; ++k) {
    if (pair.proximity.weights[k + 1] != 0) nearest.push_back(pair.second[k]);
  }
  const double cosine = std::abs(other.proximity.normal.dot(pair.proximity.normal));
  if (nearest.size() == 3 || other.proximity.distance >= pair.proximity.distance || cosine >= 1 - 1e-12) return;
  const bool covers = holds(other.first, pair.first) && holds(other.second, nearest);
  const bool covers_swapped = holds(other.second, pair.first) && holds(other.first, nearest);
  if (other.kind == PairKind::kVf) {
    rules[kByFace] |= covers;
  } else {
    const auto& w = other.proximity.weights;
    const VertexId vertex = pair.first.front();
    const bool stands_higher = cosine > 0.9 && pair.proximity.distance * cosine > (1 + 1e-6) * other.proximity.distance;
    const double longest_along = stands_higher ? kLayerThickness : std::numeric_limits<double>::infinity();
    rules[kByEdge] |= covers && distance_along(other.first, w[0], w[1], vertex, V) <= longest_along;
    rules[kByEdge] |= covers_swapped && distance_along(other.second, w[2], w[3], vertex, V) <= longest_along;
  }
}

void hold_ee_against(const Pair& pair, const Pair& other, const Positions& V, Rules& rules) {
  if (other.kind != PairKind::kVf || other.proximity.distance > pair.proximity.distance) return;
  const auto along = [&](const Feature& edge) -> Vec3 { return (V.row(edge[1]) - V.row(edge[0])).normalized(); };
  const bool parallel = along(pair.first).cross(along(pair.second)).norm() < 1e-6;
  const auto hold_end = [&](VertexId end, double weight_of_other_end, const Feature& other_edge) {
    if (other.first.front() != end || !holds(other.second, other_edge)) return;
    rules[kByEnd] |= weight_of_other_end == 0;
    rules[kByParallelEnd] |= parallel;
  };
  const auto& weights = pair.proximity.weights;
  hold_end(pair.first[0], weights[1], pair.second);
  hold_end(pair.first[1], weights[0], pair.second);
  hold_end(pair.second[0], weights[3], pair.first);
  hold_end(pair.second[1], weights[2], pair.first);
}

/// The rules by which each pair is left out; none if it is a contact.
std::vector<Rules> plain_reading(const Mesh& mesh, const Positions& V, const std::vector<PairProximity>& all) {
  std::vector<Pair> pairs;
  for (const PairProximity& pair : all) pairs.push_back(make_pair(mesh, pair));
  std::vector<Rules> rules(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (const Pair& other : pairs) {
      if (pairs[i].kind == PairKind::kVf) {
        hold_vf_against(pairs[i], other, V, rules[i]);
      } else {
        hold_ee_against(pairs[i], other, V, rules[i]);
      }
    }
  }
  return rules;
}

/// A multiple of an eighth of the spacing: vertices come over vertices, edges and insides, and distances tie.
double lattice_length(int begin, int end) { return kSpacing / 8 * integer_in(begin, end); }

/// Layers of cloth over one another, shifted and of one or the other spacing.
StepScene layers() {
  StepScene scene;
  const int count = integer_in(2, 4);
  double height = 0;
  for (int layer = 0; layer < count; ++layer) {
    const int nx = integer_in(2, 5), ny = integer_in(2, 5);
    const double scale = kSpacing / (integer_in(0, 3) == 0 ? 2 : 1);
    scene.add(make_sheet(nx, ny, scale * (nx - 1), scale * (ny - 1)),
              Vec3(lattice_length(-8, 9), lattice_length(-8, 9), height));
    height += lattice_length(1, 8);
  }
  return scene;
}

/// A sheet folded flat about a line, which is a row of edges or none, the fold a little open.
StepScene fold() {
  StepScene scene;
  const int nx = integer_in(3, 7), ny = integer_in(2, 5);
  scene.add(make_sheet(nx, ny, kSpacing * (nx - 1), kSpacing * (ny - 1)), Vec3::Zero());
  const double line = lattice_length(-8, 9), open = lattice_length(1, 6);
  for (Eigen::Index v = 0; v < scene.V_t0.rows(); ++v) {
    auto x = scene.V_t0.row(v);
    if (x.x() <= line) continue;
    x.x() = 2 * line - x.x();
    x.z() += open;
  }
  return scene;
}

/// Small shapes with corners on a coarse lattice: roofs, spikes, and edges over edges at every angle.
StepScene tetrahedra() {
  StepScene scene;
  const int count = integer_in(2, 6);
  for (int i = 0; i < count; ++i) {
    Shape shape;
    shape.x.resize(4, 3);
    for (Eigen::Index k = 0; k < 12; ++k) shape.x.data()[k] = kSpacing / 2 * integer_in(0, 6);
    shape.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
    scene.add(shape, Vec3::Zero());
  }
  return scene;
}

/// Two fans, the hub of one over that of the other or a little aside: all pairs of their spokes are near.
StepScene fans() {
  StepScene scene;
  for (int layer = 0; layer < 2; ++layer) {
    const int count = integer_in(3, 13);
    Shape shape{Positions::Zero(count + 1, 3), {}};
    for (int i = 0; i < count; ++i) {
      const double angle = 2 * std::numbers::pi * i / count;
      shape.x.row(i + 1) << 4 * kSpacing * std::cos(angle), 4 * kSpacing * std::sin(angle), 0;
      shape.triangles.push_back({0, i + 1, (i + 1) % count + 1});
    }
    const Vec3 above(lattice_length(-2, 3), lattice_length(-2, 3), lattice_length(1, 8));
    scene.add(shape, layer * above);
  }
  return scene;
}

/// One of the above; sometimes turned, so that what is equal differs by rounding, or with vertices moved off the
/// lattice.
StepScene near_contact_surfaces() {
  const int kind = integer_in(0, 4);
  StepScene scene = kind == 0 ? layers() : kind == 1 ? fold() : kind == 2 ? fans() : tetrahedra();
  const double shift = std::array{0.0, kSpacing / 32, kSpacing / 4}[static_cast<std::size_t>(integer_in(0, 3))];
  const int share = integer_in(1, 5);
  if (integer_in(0, 2) == 0)
    scene.V_t0 *= Eigen::AngleAxisd(number_between(0, 3), vector_within(1).normalized()).matrix();
  if (shift == 0) return scene;
  for (Eigen::Index v = 0; v < scene.V_t0.rows(); ++v) {
    if (integer_in(0, share) == 0) scene.V_t0.row(v) += vector_within(shift).transpose();
  }
  return scene;
}

TEST(LocalProximities, prop_are_those_of_the_plain_reading) {
  std::array<std::int64_t, kRuleCount> by_one_rule_alone{};
  std::int64_t kept = 0;
  check_property(50, 1, [&] {
    const StepScene scene = near_contact_surfaces();
    const Mesh mesh = scene.mesh();
    BoxHierarchy hierarchy(mesh);
    const std::vector<PairProximity> all = find_proximities(mesh, hierarchy, scene.V_t0, kSpacing);
    const std::vector<Rules> rules = plain_reading(mesh, scene.V_t0, all);
    const auto name = [](const PairProximity& pair) {
      return std::array{static_cast<std::int32_t>(pair.kind), pair.first, pair.second};
    };
    std::vector<std::array<std::int32_t, 3>> expected, local;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto count = std::ranges::count(rules[i], true);
      if (count == 0) expected.push_back(name(all[i]));
      if (count != 1) continue;
      ++by_one_rule_alone[static_cast<std::size_t>(std::ranges::find(rules[i], true) - rules[i].begin())];
    }
    for (const PairProximity& pair : local_proximities(mesh, VertexFaces(mesh), scene.V_t0, all, kLayerThickness))
      local.push_back(name(pair));
    kept += std::ssize(local);
    RC_ASSERT(local == expected);
  });
  // Each rule has been the only one that leaves a pair out.
  EXPECT_GT(*std::ranges::min_element(by_one_rule_alone), 10);
  EXPECT_GT(kept, 1000);
}

}  // namespace
}  // namespace selvage::sim::testbed
