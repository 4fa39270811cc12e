#include "sim/dynamics/stage_stabilizers.h"

#include <cmath>

#include "sim/base/parallel.h"

namespace selvage::sim {

StageStabilizers::StageStabilizers(const StabilizerSystem& stabilizers)
    : system_(stabilizers),
      entry_(stabilizers.stabilizers().size()),
      direction_(entry_.size()),
      pull_n_(entry_.size()) {}

void StageStabilizers::list_neighbours(VertexId i, std::vector<VertexId>& neighbours) const {
  for (const StabilizerSystem::Neighbour& neighbour : system_.neighbours_of(i)) neighbours.push_back(neighbour.vertex);
}

void StageStabilizers::find_entries(const BlockMatrix& matrix) {
  for (std::size_t n = 0; n < entry_.size(); ++n) {
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t l = 0; l < 4; ++l) {
        if (k == l || at(n).weights[k] == 0 || at(n).weights[l] == 0) continue;
        entry_[n][k][l] = matrix.find(at(n).vertices[k], at(n).vertices[l]);
      }
    }
  }
}

void StageStabilizers::look(const Positions& predicted_x) {
  parallel_each(static_cast<Eigen::Index>(entry_.size()), [&](Eigen::Index row) {
    const auto n = static_cast<std::size_t>(row);
    const Vec3 bow = bow_of(at(n), predicted_x);
    const double squared = bow.squaredNorm() + at(n).straight_m * at(n).straight_m;
    direction_[n] = squared > 0 ? Vec3(bow / std::sqrt(squared)) : Vec3::Zero();
  });
}

void StageStabilizers::add_forces(const Positions& X, double stiffness_share, double damping_share, Positions& result) {
  parallel_each(static_cast<Eigen::Index>(entry_.size()), [&](Eigen::Index row) {
    const auto n = static_cast<std::size_t>(row);
    const Vec3 bow = bow_of(at(n), X);
    pull_n_[n] = -stiffness_share * at(n).stiffness_n_m * bow -
                 damping_share * at(n).damping_n_s_m * direction_[n].dot(bow) * direction_[n];
  });
  parallel_each(result.rows(), [&](Eigen::Index i) {
    for (const StabilizerSystem::End& end : system_.ends_at(static_cast<VertexId>(i))) {
      const auto n = static_cast<std::size_t>(end.stabilizer);
      result.row(i) += at(n).weights[static_cast<std::size_t>(end.point)] * pull_n_[n].transpose();
    }
  });
}

void StageStabilizers::add_blocks(VertexId i, double h_s, BlockMatrix& matrix) const {
  for (const StabilizerSystem::End& end : system_.ends_at(i)) {
    const auto n = static_cast<std::size_t>(end.stabilizer), k = static_cast<std::size_t>(end.point);
    for (std::size_t l = 0; l < 4; ++l) {
      const double product = at(n).weights[k] * at(n).weights[l];
      if (product == 0) continue;
      SymmetricBlock block = {};
      add_identity(h_s * h_s * at(n).stiffness_n_m * product, block);
      add_outer(h_s * at(n).damping_n_s_m * product, direction_[n].x(), direction_[n].y(), direction_[n].z(), block);
      if (l == k) {
        matrix.add_diagonal(i, block);
      } else {
        matrix.add_off_diagonal(entry_[n][k][l], block);
      }
    }
  }
}

double StageStabilizers::resistance_kg(VertexId i, double h_s) const {
  double sum = 0;
  for (const StabilizerSystem::End& end : system_.ends_at(i)) {
    const Stabilizer& s = at(static_cast<std::size_t>(end.stabilizer));
    const double weight = s.weights[static_cast<std::size_t>(end.point)];
    sum += h_s * (h_s * s.stiffness_n_m + s.damping_n_s_m) * weight * weight;
  }
  return sum;
}

}  // namespace selvage::sim
