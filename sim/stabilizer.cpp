#include "sim/stabilizer.h"

#include <cmath>
#include <map>

#include "kernel/assert.h"
#include "sim/parallel.h"

namespace selvage::sim {

StabilizerSystem::StabilizerSystem(std::span<const Stabilizer> stabilizers, std::int32_t vertex_count)
    : count_(static_cast<std::int32_t>(stabilizers.size())), begin_(static_cast<std::size_t>(vertex_count) + 1) {
  std::vector<std::map<VertexId, Neighbour>> rows(static_cast<std::size_t>(vertex_count));
  for (const Stabilizer& s : stabilizers) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        if (i == j || s.weights[i] == 0 || s.weights[j] == 0) continue;
        const VertexId a = s.vertices[i], b = s.vertices[j];
        SELVAGE_ASSERT(a != b && a >= 0 && b >= 0 && a < vertex_count && b < vertex_count);
        Neighbour& entry = rows[static_cast<std::size_t>(a)].try_emplace(b, Neighbour{b, 0, 0}).first->second;
        const double product = s.weights[i] * s.weights[j];
        entry.stiffness += s.stiffness_n_m * product;
        entry.damping += s.damping_n_s_m * product;
      }
    }
  }
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (const auto& [vertex, neighbour] : rows[i]) neighbours_.push_back(neighbour);
    begin_[i + 1] = neighbours_.size();
  }
}

void StabilizerSystem::add_forces(const Positions& X, double stiffness_share, double damping_share,
                                  Positions& result) const {
  if (empty()) return;
  parallel_each(static_cast<Eigen::Index>(begin_.size()) - 1, [&](Eigen::Index i) {
    result.row(i) += force_at(X, static_cast<VertexId>(i), stiffness_share, damping_share);
  });
}

double StabilizerSystem::diagonal(VertexId i, double stiffness_share, double damping_share) const {
  double sum = 0;
  if (empty()) return sum;
  const auto row = static_cast<std::size_t>(i);
  for (std::size_t n = begin_[row]; n < begin_[row + 1]; ++n) {
    sum -= stiffness_share * neighbours_[n].stiffness + damping_share * neighbours_[n].damping;
  }
  return sum;
}

double StabilizerSystem::row_sum(VertexId i, double stiffness_share, double damping_share) const {
  double sum = diagonal(i, stiffness_share, damping_share);
  if (empty()) return sum;
  const auto row = static_cast<std::size_t>(i);
  for (std::size_t n = begin_[row]; n < begin_[row + 1]; ++n) {
    sum += std::abs(stiffness_share * neighbours_[n].stiffness + damping_share * neighbours_[n].damping);
  }
  return sum;
}

}  // namespace selvage::sim
