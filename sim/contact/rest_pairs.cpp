#include "sim/contact/rest_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "kernel/box_hierarchy.h"
#include "kernel/fp_env.h"
#include "kernel/proximities.h"
#include "kernel/proximity.h"

namespace selvage::sim {

std::vector<RestPair> find_rest_pairs(const Mesh& mesh, const PositionsRef& V_rest, double thickness_m) {
  const FpEnvGuard guard;
  std::vector<RestPair> pairs;
  if (validate(mesh, V_rest, V_rest) != InputError::kNone) return pairs;
  BoxHierarchy hierarchy(mesh);
  for (const PairProximity& near : find_proximities(mesh, hierarchy, V_rest, thickness_m)) {
    if (!(near.proximity.distance < thickness_m)) continue;
    pairs.push_back({near.kind, near.first, near.second, near.proximity.distance});
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId vertex = mesh.faces[f][k];
      const Vec3 a = V_rest.row(mesh.faces[f][(k + 1) % 3]), b = V_rest.row(mesh.faces[f][(k + 2) % 3]);
      const double distance_m = self_proximity({V_rest.row(vertex), a, b}).distance;
      if (distance_m < thickness_m) pairs.push_back({PairKind::kSelf, vertex, static_cast<FaceId>(f), distance_m});
    }
  }
  std::ranges::sort(pairs, {}, [](const RestPair& pair) { return std::tuple(pair.kind, pair.first, pair.second); });
  return pairs;
}

InputError validate(const Mesh& mesh, const std::vector<RestPair>& pairs) {
  const auto is_of_mesh = [&](const RestPair& pair) {
    const auto [first, second] = std::pair(static_cast<std::size_t>(pair.first), static_cast<std::size_t>(pair.second));
    if (pair.first < 0 || pair.second < 0) return false;
    if (pair.kind != PairKind::kEe) {
      if (pair.first >= mesh.vertex_count || second >= mesh.faces.size()) return false;
      const bool is_corner = std::ranges::find(mesh.faces[second], pair.first) != mesh.faces[second].end();
      return is_corner == (pair.kind == PairKind::kSelf);
    }
    return first < second && second < mesh.edges.size() &&
           std::ranges::find_first_of(mesh.edges[first], mesh.edges[second]) == mesh.edges[first].end();
  };
  if (!std::ranges::all_of(pairs, is_of_mesh)) return InputError::kBadSurfaces;
  const auto is_length = [](const RestPair& pair) { return pair.distance_m >= 0 && std::isfinite(pair.distance_m); };
  return std::ranges::all_of(pairs, is_length) ? InputError::kNone : InputError::kBadOption;
}

RestDistances::RestDistances(const Mesh& mesh, std::vector<RestPair> pairs)
    : vertex_count_(static_cast<std::size_t>(mesh.vertex_count)), pairs_(std::move(pairs)) {
  if (pairs_.empty()) return;
  std::ranges::sort(pairs_, {}, [this](const RestPair& pair) {
    return std::tuple(row(pair.kind, pair.first), pair.second, pair.distance_m);
  });
  begin_.assign(vertex_count_ + mesh.edges.size() + 1, 0);
  for (const RestPair& pair : pairs_) ++begin_[row(pair.kind, pair.first) + 1];
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
}

double RestDistances::of(PairKind kind, std::int32_t first, std::int32_t second) const {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  if (empty()) return kNone;
  const std::size_t at = row(kind, first);
  const auto end = pairs_.begin() + static_cast<std::ptrdiff_t>(begin_[at + 1]);
  const auto found = std::ranges::lower_bound(pairs_.begin() + static_cast<std::ptrdiff_t>(begin_[at]), end, second, {},
                                              &RestPair::second);
  return found != end && found->second == second ? found->distance_m : kNone;
}

std::size_t RestDistances::row(PairKind kind, std::int32_t first) const {
  return (kind == PairKind::kEe ? vertex_count_ : 0) + static_cast<std::size_t>(first);  // no kVf has a kSelf's face
}

}  // namespace selvage::sim
