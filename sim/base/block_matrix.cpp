#include "sim/base/block_matrix.h"

namespace selvage::sim {
namespace {

LaneTable table_of(const std::vector<std::vector<VertexId>>& neighbours) {
  std::vector<std::vector<LaneNeighbour>> numbered(neighbours.size());
  std::int32_t count = 0;
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    for (const VertexId neighbour : neighbours[i]) numbered[i].push_back({neighbour, count++});
  }
  return make_lane_table(numbered);
}

}  // namespace

BlockMatrix::BlockMatrix(const std::vector<std::vector<VertexId>>& neighbours)
    : rows_(std::ssize(neighbours)), table_(table_of(neighbours)) {
  off_diagonal_.reset(table_.item.size());
  diagonal_.reset(neighbours.size());
}

std::size_t BlockMatrix::find(VertexId i, VertexId neighbour) const {
  const auto row = static_cast<std::size_t>(i);
  std::size_t entry = kLanes * table_.begin[row / kLanes] + row % kLanes;
  while (table_.item[entry] == LaneTable::kNone || table_.neighbour[entry] != neighbour) entry += kLanes;
  return entry;
}

void BlockMatrix::clear_row(Eigen::Index i) {
  const auto row = static_cast<std::size_t>(i);
  diagonal_.set(row, {});
  for (std::size_t slot = table_.begin[row / kLanes]; slot < table_.begin[row / kLanes + 1]; ++slot) {
    off_diagonal_.set(kLanes * slot + row % kLanes, {});
  }
}

}  // namespace selvage::sim
