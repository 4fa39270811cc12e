// The pseudo-inverse of a symmetric positive semidefinite 3 by 3 matrix: inertia tensors of nodes on a line, and
// mobilities in which a direction is missing.
#pragma once

#include <Eigen/Core>

#include "kernel/sound_arithmetic.h"

namespace selvage::sim {

/// Eigenvalues at most this share of the largest count as 0. Inertia grows with the square of a lever arm, so arms
/// below 10^-6 of the longest are dropped; the eigenvalues' own error, a few u = 10^-16, stays below 10^-3 of what is
/// kept.
inline constexpr double kRankTolerance = 1e-12;

/// Above this share of the cube of the trace, a determinant says that the least eigenvalue is at least as large a share
/// of the largest: cofactors then lose three digits of sixteen at most. Eigenvalues took 9 % of all processor time
/// where 7,000 contacts rub (sim/scenes/curtain.toml at full quality, 2.83 s).
inline constexpr double kFullRank = 1e-3;

/// REQUIRES `matrix` symmetric, finite, semidefinite up to rounding. The zero matrix gives the zero matrix.
[[nodiscard]] Eigen::Matrix3d pseudo_inverse(const Eigen::Matrix3d& matrix);

}  // namespace selvage::sim
