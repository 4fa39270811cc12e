#include "sim/contact/local_proximities.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include <Eigen/Geometry>

#include "sim/base/parallel.h"

namespace selvage::sim {
namespace {

/// Below this sine of their angle two edges are as near along all of their length, to 10^-6 of it, and where the
/// nearest points were put is rounding.
constexpr double kParallelSine = 1e-6;

/// Cosine of 1.4e-6: the normals of a flat contact differ by rounding, and all of its pairs are needed.
constexpr double kSameDirection = 1 - 1e-12;

/// 25 degrees: the corners of sheets that lie on one another. A vertex above a flat ground is no higher than the edges
/// beside it, but for rounding, in whatever direction it is seen from theirs.
constexpr double kNearlySameDirection = 0.9, kHigher = 1 + 1e-6;

bool holds(const std::array<VertexId, 3>& face, VertexId vertex) {
  return face[0] == vertex || face[1] == vertex || face[2] == vertex;
}

class LocalTest {
 public:
  LocalTest(const Mesh& mesh, const VertexFaces& faces, const Positions& V,
            const std::vector<PairProximity>& proximities, double thickness_m)
      : mesh_(mesh), faces_(faces), V_(V), thickness_m_(thickness_m) {
    const auto is_vf = [](const PairProximity& pair) { return pair.kind == PairKind::kVf; };
    vf_ = {proximities.begin(), std::ranges::partition_point(proximities, is_vf)};
    const auto ee = std::span(proximities).subspan(vf_.size());
    ee_begin_.assign(static_cast<std::size_t>(V.rows()) + 1, 0);
    for (const PairProximity& pair : ee) {
      for (const VertexId v : pair.vertices) ++ee_begin_[static_cast<std::size_t>(v) + 1];
    }
    std::partial_sum(ee_begin_.begin(), ee_begin_.end(), ee_begin_.begin());
    ee_at_.resize(4 * ee.size());
    std::vector<std::size_t> next(ee_begin_.begin(), ee_begin_.end() - 1);
    for (const PairProximity& pair : ee) {
      for (const VertexId v : pair.vertices) ee_at_[next[static_cast<std::size_t>(v)]++] = &pair;
    }
    nearest_edge_.assign(static_cast<std::size_t>(V.rows()), std::numeric_limits<double>::infinity());
    for (const PairProximity& pair : ee) {
      for (const VertexId v : pair.vertices) {
        double& nearest = nearest_edge_[static_cast<std::size_t>(v)];
        nearest = std::min(nearest, pair.proximity.distance);
      }
    }
  }

  [[nodiscard]] bool is_local(const PairProximity& pair) const {
    return pair.kind == PairKind::kVf ? is_local_vf(pair) : is_local_ee(pair);
  }

 private:
  /// The edge pairs that the vertex belongs to.
  [[nodiscard]] std::span<const PairProximity* const> edges_near(VertexId vertex) const {
    const auto v = static_cast<std::size_t>(vertex);
    return std::span(ee_at_).subspan(ee_begin_[v], ee_begin_[v + 1] - ee_begin_[v]);
  }
  /// The pairs of the vertex with faces.
  [[nodiscard]] std::span<const PairProximity> faces_near(VertexId vertex) const {
    const auto begin = std::ranges::lower_bound(vf_, vertex, {}, &PairProximity::first);
    return {begin, std::ranges::upper_bound(vf_, vertex, {}, &PairProximity::first)};
  }
  [[nodiscard]] bool face_holds(const PairProximity& vf, VertexId vertex) const {
    return holds(mesh_.faces[static_cast<std::size_t>(vf.second)], vertex);
  }

  /// Along the other's direction, which is nearly its own.
  [[nodiscard]] static bool stands_higher(const PairProximity& pair, const PairProximity& other) {
    const double cosine = std::abs(other.proximity.normal.dot(pair.proximity.normal));
    return cosine > kNearlySameDirection && pair.proximity.distance * cosine > kHigher * other.proximity.distance;
  }

  /// From the vertex, an end of one of the pair's edges, to the point of the edge that is nearest to the other one.
  [[nodiscard]] double distance_along(const PairProximity& ee, VertexId vertex) const {
    const auto end = static_cast<std::size_t>(std::ranges::find(ee.vertices, vertex) - ee.vertices.begin());
    const std::size_t partner = end ^ 1;
    return ee.proximity.weights[partner] * (V_.row(ee.vertices[partner]) - V_.row(vertex)).norm();
  }

  [[nodiscard]] bool is_local_vf(const PairProximity& pair) const {
    std::array<VertexId, 3> corners{};  // of the edge or corner that is nearest
    std::size_t count = 0;
    for (std::size_t k = 1; k < 4; ++k) {
      if (pair.proximity.weights[k] != 0) corners[count++] = pair.vertices[k];
    }
    if (count == 3) return true;
    const auto nearer = [&](const PairProximity& other) {
      return other.proximity.distance < pair.proximity.distance &&
             std::abs(other.proximity.normal.dot(pair.proximity.normal)) < kSameDirection;
    };
    const auto all_corners = [&](const auto& is_held) { return std::all_of(&corners[0], &corners[count], is_held); };
    const VertexId vertex = pair.first;
    for (const PairProximity& other : faces_near(vertex)) {
      if (nearer(other) && all_corners([&](VertexId v) { return face_holds(other, v); })) return false;
    }
    if (!(nearest_edge_[static_cast<std::size_t>(vertex)] < pair.proximity.distance)) return true;
    for (const PairProximity* other : edges_near(vertex)) {
      if (!nearer(*other)) continue;  // first: over the tip of a cone of n faces 8 n edge pairs are as near, not nearer
      const std::size_t across = other->vertices[0] == vertex || other->vertices[1] == vertex ? 2 : 0;
      const std::array<VertexId, 2> edge{other->vertices[across], other->vertices[across + 1]};
      if (!all_corners([&](VertexId v) { return v == edge[0] || v == edge[1]; })) continue;
      if (distance_along(*other, vertex) <= thickness_m_ || !stands_higher(pair, *other)) return false;
    }
    return true;
  }

  [[nodiscard]] bool are_parallel(const PairProximity& pair) const {
    const auto row = [&](std::size_t k) -> Vec3 { return V_.row(pair.vertices[k]); };
    const Vec3 a = (row(1) - row(0)).stableNormalized(), b = (row(3) - row(2)).stableNormalized();
    return a.cross(b).norm() < kParallelSine;
  }

  [[nodiscard]] bool is_local_ee(const PairProximity& pair) const {
    const bool parallel = are_parallel(pair);
    for (std::size_t end = 0; end < 4; ++end) {
      const std::size_t partner = end ^ 1;  // the other end of the same edge
      if (!parallel && pair.proximity.weights[partner] != 0) continue;
      // The faces of the edge, not those near the vertex: of two fans of n faces n^2 pairs of spokes end at a hub that
      // is near n faces.
      const std::span<const PairProximity> near = faces_near(pair.vertices[end]);
      const VertexId a = pair.vertices[end < 2 ? 2 : 0], b = pair.vertices[end < 2 ? 3 : 1];
      const bool covered = std::ranges::any_of(faces_.of_either(a, b), [&](FaceId face) {
        if (!corner_across(mesh_.faces[static_cast<std::size_t>(face)], a, b)) return false;
        const auto other = std::ranges::lower_bound(near, face, {}, &PairProximity::second);
        return other != near.end() && other->second == face && other->proximity.distance <= pair.proximity.distance;
      });
      if (covered) return false;
    }
    return true;
  }

  const Mesh& mesh_;
  const VertexFaces& faces_;
  const Positions& V_;
  const double thickness_m_;
  std::span<const PairProximity> vf_;
  std::vector<const PairProximity*> ee_at_;  ///< each edge pair at its four vertices, by vertex
  std::vector<std::size_t> ee_begin_;        ///< of each vertex's; one more at the end
  std::vector<double> nearest_edge_;         ///< #V: the least distance of those, or infinity
};

}  // namespace

std::vector<PairProximity> local_proximities(const Mesh& mesh, const VertexFaces& faces, const Positions& V,
                                             const std::vector<PairProximity>& proximities, double thickness_m) {
  const LocalTest test(mesh, faces, V, proximities, thickness_m);
  std::vector<std::uint8_t> is_local(proximities.size());
  parallel_each(std::ssize(proximities), [&](Eigen::Index i) {
    const auto pair = static_cast<std::size_t>(i);
    is_local[pair] = test.is_local(proximities[pair]);
  });
  std::vector<PairProximity> local;
  local.reserve(static_cast<std::size_t>(std::ranges::count(is_local, std::uint8_t{1})));
  for (std::size_t pair = 0; pair < proximities.size(); ++pair) {
    if (is_local[pair] != 0) local.push_back(proximities[pair]);
  }
  return local;
}

}  // namespace selvage::sim
