#include "sim/near_pairs.h"

#include <algorithm>

#include "kernel/collisions.h"
#include "sim/parallel.h"
#include "sim/quick_proximity.h"
#include "sim/repulsion.h"

namespace selvage::sim {
namespace {

/// Room for the rounding of quick_proximity where distances are compared. Too much costs queries, too little an answer:
/// far above 2^-52, far below what tells two pairs apart.
constexpr double kRounding = 1 + 1e-6;

NearPair make_near_pair(PairKind kind, const std::array<VertexId, 4>& vertices, const ContactTable& contacts,
                        const Positions& V) {
  PairVectors x;
  for (std::size_t k = 0; k < 4; ++k) x[k] = V.row(vertices[k]);
  const QuickProximity quick = quick_proximity(kind, x);
  return {vertices, quick.weights, quick.direction, quick.distance, contacts.of(kind, vertices).thickness_m};
}

bool comes_near(const NearPair& pair, const Positions& V_t0, const Positions& V_t1) {
  Vec3 moved = Vec3::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    const VertexId v = pair.vertices[k];
    moved += pair.weights[k] * (V_t1.row(v) - V_t0.row(v)).transpose();
  }
  return !(pair.distance + moved.dot(pair.direction) >= pair.thickness_m);
}

}  // namespace

void NearPairs::find(const Mesh& mesh, const ContactTable& contacts, const Candidates& candidates,
                     const Positions& V_t0) {
  vertex_count_ = V_t0.rows();
  const std::size_t vf_count = candidates.vf.size();
  pairs_.resize(vf_count + candidates.ee.size());
  parallel_each(std::ssize(pairs_), [&](Eigen::Index i) {
    const auto at = static_cast<std::size_t>(i);
    if (at < vf_count) {
      const auto [vertex, face] = candidates.vf[at];
      pairs_[at] = make_near_pair(PairKind::kVf, pair_vertices(mesh, PairKind::kVf, vertex, face), contacts, V_t0);
    } else {
      const auto [a, b] = candidates.ee[at - vf_count];
      pairs_[at] = make_near_pair(PairKind::kEe, pair_vertices(mesh, PairKind::kEe, a, b), contacts, V_t0);
    }
  });
  candidates_.vf.clear();
  candidates_.ee.clear();
  std::size_t count = 0;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    if (pairs_[i].distance > kRounding * kContactReach * pairs_[i].thickness_m) continue;
    pairs_[count++] = pairs_[i];
    if (i < vf_count) {
      candidates_.vf.push_back(candidates.vf[i]);
    } else {
      candidates_.ee.push_back(candidates.ee[i - vf_count]);
    }
  }
  pairs_.resize(count);
}

std::vector<std::size_t> NearPairs::approaching(const Positions& V_t0, const Positions& V_t1) const {
  std::vector<std::uint8_t> comes(pairs_.size());
  parallel_each(std::ssize(pairs_), [&](Eigen::Index i) {
    const auto at = static_cast<std::size_t>(i);
    comes[at] = comes_near(pairs_[at], V_t0, V_t1);
  });
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < comes.size(); ++i) {
    if (comes[i] != 0) result.push_back(i);
  }
  return result;
}

std::vector<std::size_t> NearPairs::with_nearer(const std::vector<std::size_t>& pairs) const {
  std::vector<double> reach(static_cast<std::size_t>(vertex_count_), -1);  // the farthest of `pairs` at each vertex
  std::vector<std::uint8_t> is_taken(pairs_.size());
  for (const std::size_t i : pairs) {
    is_taken[i] = 1;
    for (const VertexId v : pairs_[i].vertices) {
      double& farthest = reach[static_cast<std::size_t>(v)];
      farthest = std::max(farthest, kRounding * pairs_[i].distance);
    }
  }
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const NearPair& pair = pairs_[i];
    const auto is_nearer = [&](VertexId v) { return pair.distance <= reach[static_cast<std::size_t>(v)]; };
    const auto* second_side = pair.vertices.begin() + (i < candidates_.vf.size() ? 1 : 2);
    if (is_taken[i] != 0 || (std::any_of(pair.vertices.begin(), second_side, is_nearer) &&
                             std::any_of(second_side, pair.vertices.end(), is_nearer))) {
      result.push_back(i);
    }
  }
  return result;
}

std::optional<std::size_t> NearPairs::place(PairKind kind, std::int32_t first, std::int32_t second) const {
  const auto place_in = [](const auto& sorted, const auto& pair) -> std::optional<std::size_t> {
    const auto at = std::ranges::lower_bound(sorted, pair);
    if (at == sorted.end() || *at != pair) return std::nullopt;
    return static_cast<std::size_t>(at - sorted.begin());
  };
  if (kind == PairKind::kVf) return place_in(candidates_.vf, VfCandidate{first, second});
  const auto ee = place_in(candidates_.ee, EeCandidate{first, second});
  if (!ee) return std::nullopt;
  return candidates_.vf.size() + *ee;
}

Candidates NearPairs::candidates(const std::vector<std::size_t>& pairs) const {
  Candidates result;
  for (const std::size_t i : pairs) {
    if (i < candidates_.vf.size()) {
      result.vf.push_back(candidates_.vf[i]);
    } else {
      result.ee.push_back(candidates_.ee[i - candidates_.vf.size()]);
    }
  }
  return result;
}

}  // namespace selvage::sim
