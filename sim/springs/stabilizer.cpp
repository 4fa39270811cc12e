#include "sim/springs/stabilizer.h"

#include <cmath>
#include <map>
#include <utility>

#include "kernel/assert.h"

namespace selvage::sim {

StabilizerSystem::StabilizerSystem(std::vector<Stabilizer> stabilizers, std::int32_t vertex_count)
    : stabilizers_(std::move(stabilizers)) {
  std::vector<std::vector<End>> ends(static_cast<std::size_t>(vertex_count));
  std::vector<std::map<VertexId, double>> coefficients(ends.size());
  for (std::size_t n = 0; n < stabilizers_.size(); ++n) {
    const Stabilizer& s = stabilizers_[n];
    for (std::size_t i = 0; i < 4; ++i) {
      if (s.weights[i] == 0) continue;
      const VertexId a = s.vertices[i];
      SELVAGE_ASSERT(a >= 0 && a < vertex_count);
      ends[static_cast<std::size_t>(a)].push_back({static_cast<std::int32_t>(n), static_cast<std::int32_t>(i)});
      for (std::size_t j = 0; j < 4; ++j) {
        if (i == j || s.weights[j] == 0) continue;
        SELVAGE_ASSERT(a != s.vertices[j]);
        coefficients[static_cast<std::size_t>(a)][s.vertices[j]] += s.stiffness_n_m * (s.weights[i] * s.weights[j]);
      }
    }
  }
  for (std::size_t i = 0; i < ends.size(); ++i) {
    ends_.items.insert(ends_.items.end(), ends[i].begin(), ends[i].end());
    ends_.begin.push_back(ends_.items.size());
    for (const auto& [vertex, coefficient] : coefficients[i]) neighbours_.items.push_back({vertex, coefficient});
    neighbours_.begin.push_back(neighbours_.items.size());
  }
}

double StabilizerSystem::row_sum_n_m(VertexId i) const {
  double diagonal = 0, others = 0;
  for (const Neighbour& neighbour : neighbours_of(i)) {
    diagonal -= neighbour.coefficient_n_m;
    others += std::abs(neighbour.coefficient_n_m);
  }
  return diagonal + others;
}

}  // namespace selvage::sim
