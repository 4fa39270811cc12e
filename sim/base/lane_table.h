// Who is next to whom, for blocks of lanes: the vertices of a block look at one neighbour each at once.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/base/lane_vectors.h"

namespace selvage::sim {

/// A block is kLanes vertices that follow one another; it has slots, and a slot holds one neighbour for each lane, or
/// none. Entry kLanes * slot + lane. Where neighbours follow one another too, as in a grid, whole vectors are read.
struct LaneTable {
  static constexpr std::int32_t kNone = -1;

  std::vector<std::uint32_t> begin{0};  ///< the slots of block b are [begin[b], begin[b + 1]), and in those before
  std::vector<std::uint32_t> run_end;   ///< run_end[b] the neighbour of lane k is first + k, where there is one
  std::vector<std::int32_t> first;  ///< by slot before run_end; at most kLanes - 1 beside the vertices that there are
  std::vector<std::int32_t> neighbour;  ///< by entry; another lane's where there is none
  std::vector<std::int32_t> item;       ///< by entry; kNone where there is none

  /// values[item] for every entry, zero where there is none.
  [[nodiscard]] std::vector<double> spread(const std::vector<double>& values) const;
};

struct LaneNeighbour {
  VertexId vertex;
  std::int32_t item;  ///< the caller's number for it, >= 0
};

/// neighbours[i] are those of vertex i.
[[nodiscard]] LaneTable make_lane_table(const std::vector<std::vector<LaneNeighbour>>& neighbours);

}  // namespace selvage::sim
