// Two material points of the surface that interact, one in each feature of a pair (paper, 7.1). Their relative motion
// is a weighted sum over the pair's vertices, and a change of it is shared out with the same weights.
//   Legend: w weights, m^-1 mobility, K = sum of w^2 m^-1 (what an impulse of 1 changes the relative motion by).
#pragma once

#include <array>
#include <span>

#include "kernel/collisions.h"

namespace selvage::sim {

using PairVectors = std::array<Vec3, 4>;  ///< one vector for each vertex of a pair, in the pair's order
/// Eigen leaves the elements of PairVectors{} as they are in memory.
[[nodiscard]] inline PairVectors zero_vectors() { return {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()}; }

struct Interaction {
  std::array<VertexId, 4> vertices{};  ///< in the order of pair_vertices()
  /// Signed: the point of the first feature minus the point of the second is sum_i weights[i] x_i. Sum 0 up to
  /// rounding.
  std::array<double, 4> weights{};
  std::size_t vertex_count = 4;  ///< 3 for a self pair {p, a, b, p}, whose last slot has weight and mobility 0
  /// Inverse masses over the largest of the four: in [0, 1]; 0 for scripted vertices. Below kLeastMobility a vertex
  /// counts as scripted, so that no product of masses leaves the range of doubles.
  std::array<double, 4> mobility{};
  double inverse_mass_scale = 0;  ///< the largest of the four, 1/kg; 0 where nothing can move
};

/// 2^-100: beside a vertex 10^30 times as light the heavy one's change is far below its own rounding.
inline constexpr double kLeastMobility = 0x1p-100;

/// Of the pair's vertex i.
[[nodiscard]] bool is_in_first_feature(PairKind kind, std::size_t i);
/// As in Interaction, of `weights` as in Proximity and CcdResult.
[[nodiscard]] std::array<double, 4> signed_weights(PairKind kind, const std::array<double, 4>& weights);

/// `weights` as in Proximity and CcdResult.
[[nodiscard]] Interaction make_interaction(PairKind kind, const std::array<VertexId, 4>& vertices,
                                           const std::array<double, 4>& weights, std::span<const double> inverse_mass);

/// The four rows of X, #V by 3.
[[nodiscard]] PairVectors gather(const Interaction& interaction, const Positions& X);
/// First point minus second, for positions as for displacements. Differences are taken first: an offset costs nothing.
[[nodiscard]] Vec3 relative(const Interaction& interaction, const PairVectors& x);
/// K, with mobilities.
[[nodiscard]] double effective_mobility(const Interaction& interaction);
/// Whether cloth alone takes part, so that momentum is kept: no vertex of the pair is scripted.
[[nodiscard]] bool is_closed(const Interaction& interaction);

/// A vertex moves at most this many times the relative change asked for. The plain formula w m^-1 / K, the lever, is at
/// most (1 + sqrt(3)) / 2 = 1.37 where all corners of a feature are free and of one mass; it grows without bound where
/// the only free corner of a pinned triangle, or by far its lightest, has a weight near 0, and would throw that away.
inline constexpr double kMaxLever = 8;
/// The share in (0, 1] of an impulse that kMaxLever lets through: all up to it, then (kMaxLever / lever)^2. So what is
/// moved fades out where it helps ever less, kMaxLever^2 / lever times what was asked for: of 8 times for any lever,
/// which a few contacts of one corner add up to, edges whose pins passed each other at 8 m/s made 180 m/s, and make 24.
/// REQUIRES effective_mobility() > 0.
[[nodiscard]] double lever_share(const Interaction& interaction);

/// Changes of the vertices' displacements that change the relative displacement by `change` (less where kMaxLever says
/// so): equal and opposite impulses, weighted (paper, 7.1, for any masses). Zero where nothing can move.
/// Linear momentum is kept for closed pairs; angular momentum where `change` is parallel to the points' separation.
[[nodiscard]] PairVectors distribute(const Interaction& interaction, const Vec3& change);

}  // namespace selvage::sim
