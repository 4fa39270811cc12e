// One level of subdivision as two linear rules: midpoints, which lie on the surface, and smoother places (paper, 8).
//
// The smooth rule is Loop's with other weights at vertices of valence n other than 6. The ring of n edges that meet
// there is a circulant matrix; its eigenvalues are chosen as 1/2^min(k, n-k) for the Fourier modes k > 0, which is what
// Loop's rule has at n = 6, so the limit has bounded curvature at every valence: subdominant 1/2 twice, all others at
// most 1/4 = (1/2)^2. (Loop's own weights have 0.53 and 0.32 at n = 7: curvature grows without bound.) The weight of
// the vertex itself makes mode 0 fit: 1 - alpha - beta = 1/4, alpha <= 3/8 as large as keeps all weights >= 0. So every
// new place is a convex combination of old ones. (Loop, MSR-TR-2001-24, reaches both properties with other numbers.)
#pragma once

#include <vector>

#include "kernel/mesh.h"
#include "sim/scene/shapes.h"

namespace selvage::sim {

/// Weights around an inner vertex with n neighbours.
struct RingWeights {
  double alpha = 0;          ///< of the vertex, in the new point of an edge that ends there
  double beta = 0;           ///< of all neighbours together, in the vertex' own new place
  std::vector<double> ring;  ///< of the neighbour j places on from the edge's other end; sum 1 - alpha, all >= 0
};
/// REQUIRES n >= 3. O(n).
[[nodiscard]] RingWeights ring_weights(std::int32_t n);

/// A row of a rule: the new point is the sum of weight times old point; weights >= 0 with sum 1.
struct RuleTerm {
  VertexId vertex;
  double weight;
};

/// Vertices of the finer mesh: those of the coarse one with their numbers, then one for each edge, in the order of
/// Mesh::edges. Face f becomes faces 4 f .. 4 f + 3: its three corners, then its middle.
class LoopRules {
 public:
  /// Vertices of faces flagged in `rigid` (#F, or empty) stay where they are, and the new points of these faces'
  /// edges at the midpoints. At boundaries the surface follows the cubic B-spline of the boundary; vertices that are
  /// neither inner nor on one boundary (of no face, where surfaces meet in a point or along an edge, or where two faces
  /// lie back to back) stay. Which way round faces are does not matter. Time and memory O(n^2) at an inner vertex of n
  /// edges: the new point of each of them is of all n.
  LoopRules(const Mesh& coarse, const std::vector<std::uint8_t>& rigid);

  [[nodiscard]] const io::Triangles& triangles() const { return triangles_; }
  /// Flags of the finer vertices that the smooth rule may move.
  [[nodiscard]] const std::vector<std::uint8_t>& moves() const { return moves_; }
  /// Rounded midpoints.
  [[nodiscard]] Positions midpoints(const PositionsRef& V) const;
  [[nodiscard]] Positions smooth(const PositionsRef& V) const;

 private:
  std::vector<std::array<VertexId, 2>> edges_;
  std::int32_t coarse_count_;
  io::Triangles triangles_;
  std::vector<std::uint8_t> moves_;
  std::vector<std::vector<RuleTerm>> rows_;  ///< empty where nothing moves
};

}  // namespace selvage::sim
