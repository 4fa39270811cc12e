#include "sim/subdivision/loop_rules.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <span>
#include <utility>

#include "kernel/assert.h"
#include "sim/base/parallel.h"
#include "sim/base/vertex_faces.h"

namespace selvage::sim {
namespace {

constexpr std::size_t kLeastValence = 3;

/// What is around a vertex.
struct VertexRing {
  enum class Kind { kInner, kBoundary, kOther } kind = Kind::kOther;
  std::vector<VertexId> neighbours;  ///< kInner: in order around the vertex; kBoundary: its two along the boundary
};

// The faces at a vertex as links between its neighbours; one closed chain is an inner vertex, one open chain a
// boundary. Whatever way round the faces are: cloth has no outside.
VertexRing ring_of(VertexId vertex, const Mesh& mesh, std::span<const FaceId> faces_at) {
  std::map<VertexId, std::vector<VertexId>> linked;
  for (const FaceId face : faces_at) {
    const auto& f = mesh.faces[static_cast<std::size_t>(face)];
    const std::size_t k = f[0] == vertex ? 0 : (f[1] == vertex ? 1 : 2);
    const VertexId from = f[(k + 1) % 3], to = f[(k + 2) % 3];
    linked[from].push_back(to);
    linked[to].push_back(from);
  }
  if (linked.empty()) return {};
  const auto is_end = [](const auto& neighbour) { return neighbour.second.size() == 1; };
  const auto first_end = std::ranges::find_if(linked, is_end);
  const bool open = first_end != linked.end();
  VertexRing ring;
  VertexId before = -1, now = open ? first_end->first : linked.begin()->first;
  do {
    ring.neighbours.push_back(now);
    const std::vector<VertexId>& beside = linked.at(now);
    if (beside.size() > 2) return {};
    const VertexId next = beside.front() != before ? beside.front() : beside.back();
    if (next == before) break;  // the other end
    before = std::exchange(now, next);
  } while (now != ring.neighbours.front());
  if (ring.neighbours.size() != linked.size()) return {};          // several chains
  if (!open && ring.neighbours.size() < kLeastValence) return {};  // two faces back to back
  ring.kind = open ? VertexRing::Kind::kBoundary : VertexRing::Kind::kInner;
  if (open) ring.neighbours = {ring.neighbours.front(), ring.neighbours.back()};
  return ring;
}

void add(std::vector<RuleTerm>& row, VertexId vertex, double weight) {
  if (weight == 0) return;
  const auto found = std::find_if(row.begin(), row.end(), [&](const RuleTerm& t) { return t.vertex == vertex; });
  if (found == row.end()) {
    row.push_back({vertex, weight});
  } else {
    found->weight += weight;
  }
}

using WeightsByValence = std::map<std::size_t, RingWeights>;

WeightsByValence weights_of(const std::vector<VertexRing>& rings) {
  WeightsByValence weights;
  for (const VertexRing& ring : rings) {
    const std::size_t n = ring.neighbours.size();
    if (ring.kind == VertexRing::Kind::kInner && !weights.contains(n)) {
      weights.emplace(n, ring_weights(static_cast<std::int32_t>(n)));
    }
  }
  return weights;
}

// The new point of the edge from an inner vertex to `other`, by that vertex' rule. O(n), in a row that is not empty
// O(n #row).
void add_ring_rule(std::vector<RuleTerm>& row, VertexId vertex, const VertexRing& ring, const RingWeights& weights,
                   VertexId other, double share) {
  const bool all_are_new = row.empty();
  const auto put = [&](VertexId at, double weight) {
    if (!all_are_new) return add(row, at, weight);
    if (weight != 0) row.push_back({at, weight});
  };
  const std::size_t n = ring.neighbours.size();
  const auto at = static_cast<std::size_t>(std::ranges::find(ring.neighbours, other) - ring.neighbours.begin());
  put(vertex, share * weights.alpha);
  for (std::size_t j = 0; j < n; ++j) put(ring.neighbours[(at + j) % n], share * weights.ring[j]);
}

std::vector<RuleTerm> vertex_rule(VertexId vertex, const VertexRing& ring, const WeightsByValence& weights) {
  std::vector<RuleTerm> row;
  if (ring.kind == VertexRing::Kind::kBoundary) {
    row = {{vertex, 0.75}, {ring.neighbours[0], 0.125}, {ring.neighbours[1], 0.125}};
  } else if (ring.kind == VertexRing::Kind::kInner) {
    const double beta = weights.at(ring.neighbours.size()).beta;
    row.push_back({vertex, 1 - beta});
    for (const VertexId neighbour : ring.neighbours) {
      row.push_back({neighbour, beta / double(ring.neighbours.size())});
    }
  }
  return row;
}

bool is_extraordinary(const VertexRing& ring) {
  return ring.kind == VertexRing::Kind::kInner && ring.neighbours.size() != 6;
}

// `opposite`: the third vertices of the edge's faces.
std::vector<RuleTerm> edge_rule(const std::array<VertexId, 2>& edge, const std::vector<VertexId>& opposite,
                                const std::vector<VertexRing>& rings, const WeightsByValence& weights) {
  std::vector<RuleTerm> row;
  if (opposite.size() != 2) return row;  // a boundary: its B-spline has the midpoint
  const double extraordinary = int(is_extraordinary(rings[static_cast<std::size_t>(edge[0])])) +
                               int(is_extraordinary(rings[static_cast<std::size_t>(edge[1])]));
  if (extraordinary == 0) {
    return {{edge[0], 0.375}, {edge[1], 0.375}, {opposite[0], 0.125}, {opposite[1], 0.125}};
  }
  for (std::size_t k = 0; k < 2; ++k) {
    const VertexRing& ring = rings[static_cast<std::size_t>(edge[k])];
    if (!is_extraordinary(ring)) continue;
    add_ring_rule(row, edge[k], ring, weights.at(ring.neighbours.size()), edge[1 - k], 1 / extraordinary);
  }
  return row;
}

}  // namespace

RingWeights ring_weights(std::int32_t n) {
  SELVAGE_ASSERT(n >= std::int32_t{kLeastValence});
  RingWeights weights;
  std::vector<double> wave(static_cast<std::size_t>(n));
  constexpr std::int32_t kLastMode = 60;  // all beyond are 2^-59 together, below the rounding of a weight
  for (std::int32_t j = 0; j < n; ++j) {
    for (std::int32_t k = 1; k < n; ++k) {
      if (k == kLastMode + 1) k = std::max(k, n - kLastMode);
      // j k modulo n first: the cosine of a large multiple would lose digits.
      const double angle = 2 * std::numbers::pi * double((std::int64_t{j} * k) % n) / n;
      wave[static_cast<std::size_t>(j)] += std::ldexp(std::cos(angle), -std::min(k, n - k));
    }
  }
  const double least = *std::min_element(wave.begin(), wave.end());
  const double mode_0 = std::max(0.625, -least);
  weights.alpha = 1 - mode_0;
  weights.beta = 0.75 - weights.alpha;
  for (const double value : wave) weights.ring.push_back(std::max(0.0, (mode_0 + value) / n));
  return weights;
}

LoopRules::LoopRules(const Mesh& coarse, const std::vector<std::uint8_t>& rigid)
    : edges_(coarse.edges), coarse_count_(coarse.vertex_count) {
  const auto vertex_count = static_cast<std::size_t>(coarse_count_);
  std::vector<std::uint8_t> stays(vertex_count, 0), edge_stays(edges_.size(), 0);
  std::vector<std::vector<VertexId>> opposite(edges_.size());
  for (std::size_t f = 0; f < coarse.faces.size(); ++f) {
    const auto& face = coarse.faces[f];
    std::array<VertexId, 3> middle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto edge = static_cast<std::size_t>(coarse.face_edges[f][k]);
      if (!rigid.empty() && rigid[f] != 0) stays[static_cast<std::size_t>(face[k])] = edge_stays[edge] = 1;
      opposite[edge].push_back(face[k]);
      middle[k] = coarse_count_ + coarse.face_edges[f][k];
    }
    for (std::size_t k = 0; k < 3; ++k) triangles_.push_back({face[k], middle[(k + 2) % 3], middle[(k + 1) % 3]});
    triangles_.push_back(middle);
  }
  const VertexFaces faces(coarse);
  std::vector<VertexRing> rings;
  for (VertexId v = 0; v < coarse_count_; ++v) rings.push_back(ring_of(v, coarse, faces.of(v)));
  const WeightsByValence weights = weights_of(rings);
  for (std::size_t v = 0; v < vertex_count; ++v) {
    rows_.push_back(stays[v] != 0 ? std::vector<RuleTerm>{} : vertex_rule(static_cast<VertexId>(v), rings[v], weights));
  }
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    rows_.push_back(edge_stays[e] != 0 ? std::vector<RuleTerm>{} : edge_rule(edges_[e], opposite[e], rings, weights));
  }
  for (const auto& row : rows_) moves_.push_back(row.empty() ? 0 : 1);
}

Positions LoopRules::midpoints(const PositionsRef& V) const {
  Positions fine(coarse_count_ + static_cast<Eigen::Index>(edges_.size()), 3);
  fine.topRows(coarse_count_) = V;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    fine.row(coarse_count_ + static_cast<Eigen::Index>(e)) = 0.5 * V.row(edges_[e][0]) + 0.5 * V.row(edges_[e][1]);
  }
  return fine;
}

Positions LoopRules::smooth(const PositionsRef& V) const {
  Positions fine = midpoints(V);
  parallel_each(fine.rows(), [&](Eigen::Index i) {
    const std::vector<RuleTerm>& row = rows_[static_cast<std::size_t>(i)];
    if (row.empty()) return;
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    for (const RuleTerm& term : row) sum += term.weight * V.row(term.vertex);
    fine.row(i) = sum;
  });
  return fine;
}

}  // namespace selvage::sim
