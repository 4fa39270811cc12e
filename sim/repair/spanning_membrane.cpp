#include "sim/repair/spanning_membrane.h"

#include <algorithm>

#include <Eigen/SparseCholesky>

namespace selvage::sim {

Neighbours neighbours_of(const Mesh& mesh) {
  Neighbours neighbours(static_cast<std::size_t>(mesh.vertex_count));
  for (const auto& edge : mesh.edges) {
    neighbours[static_cast<std::size_t>(edge[0])].push_back(edge[1]);
    neighbours[static_cast<std::size_t>(edge[1])].push_back(edge[0]);
  }
  return neighbours;
}

std::size_t index_in(const Region& region, VertexId v) {
  const auto found = std::ranges::lower_bound(region, v);
  return found != region.end() && *found == v ? static_cast<std::size_t>(found - region.begin()) : region.size();
}

std::optional<Positions> spanning_membrane(const Neighbours& neighbours, const Region& region, const Positions& x) {
  const auto count = static_cast<Eigen::Index>(region.size());
  std::vector<Eigen::Triplet<double>> entries;
  Positions right = Positions::Zero(count, 3);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& around = neighbours[static_cast<std::size_t>(region[static_cast<std::size_t>(i)])];
    entries.emplace_back(i, i, static_cast<double>(around.size()));
    for (const VertexId v : around) {
      const auto j = static_cast<Eigen::Index>(index_in(region, v));
      if (j < count) {
        entries.emplace_back(i, j, -1.0);
      } else {
        right.row(i) += x.row(v);
      }
    }
  }
  Eigen::SparseMatrix<double> laplacian(count, count);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors(laplacian);
  if (factors.info() != Eigen::Success) return std::nullopt;  // solve() would leave what it returns unwritten
  return factors.solve(Eigen::MatrixXd(right));
}

}  // namespace selvage::sim
