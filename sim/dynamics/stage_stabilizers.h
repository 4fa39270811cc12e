// Stabilisers within an implicit stage: their forces, and their part of Newton's matrix.
#pragma once

#include <array>
#include <vector>

#include "sim/base/block_matrix.h"
#include "sim/springs/stabilizer.h"

namespace selvage::sim {

/// Damping acts along the bows where the velocity before would take them, so that it is linear in x: those of cloth
/// that is nearly flat turn too far within a step for Newton's method. What torque is left is of the order of the
/// method.
class StageStabilizers {
 public:
  explicit StageStabilizers(const StabilizerSystem& stabilizers);  ///< outlives it

  /// Adds the vertices that vertex i shares a stabiliser with to `neighbours`, which may hold them already.
  void list_neighbours(VertexId i, std::vector<VertexId>& neighbours) const;
  /// Finds their blocks. REQUIRES those neighbours in `matrix`.
  void find_entries(const BlockMatrix& matrix);

  void look(const Positions& predicted_x);
  /// Adds minus (stiffness_share K + damping_share D) X.
  void add_forces(const Positions& X, double stiffness_share, double damping_share, Positions& result);
  /// Adds row i of h_s^2 K + h_s D.
  void add_blocks(VertexId i, double h_s, BlockMatrix& matrix) const;
  /// The diagonal of that at most, whatever the bows.
  [[nodiscard]] double resistance_kg(VertexId i, double h_s) const;

 private:
  [[nodiscard]] const Stabilizer& at(std::size_t n) const { return system_.stabilizers()[n]; }

  const StabilizerSystem& system_;
  std::vector<std::array<std::array<std::size_t, 4>, 4>> entry_;  ///< of each: the blocks between its points
  std::vector<Vec3> direction_;  ///< n of Stabilizer: shorter where the bow is nearly straight
  std::vector<Vec3> pull_n_;     ///< on the material point of positive weight
};

}  // namespace selvage::sim
