#include "sim/base/lane_table.h"

#include <algorithm>
#include <array>
#include <map>
#include <span>

namespace selvage::sim {
namespace {

/// Lanes that must have a neighbour at the same distance for a slot of their own. With fewer, reading lanes one by one
/// costs less than a slot that is mostly empty.
constexpr std::ptrdiff_t kRunLanes = kLanes / 2;

using Slot = std::array<const LaneNeighbour*, kLanes>;

class TableBuilder {
 public:
  explicit TableBuilder(LaneTable& table) : table_(table) {}

  void add_block(VertexId row, std::span<const std::vector<LaneNeighbour>> lanes) {
    std::map<std::int32_t, Slot> at_distance;
    std::array<std::vector<const LaneNeighbour*>, kLanes> single;
    for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
      for (const LaneNeighbour& neighbour : lanes[lane]) {
        const LaneNeighbour*& place = at_distance[neighbour.vertex - row - static_cast<VertexId>(lane)][lane];
        if (place == nullptr) {
          place = &neighbour;
        } else {
          single[lane].push_back(&neighbour);
        }
      }
    }
    for (const auto& [distance, slot] : at_distance) {
      if (std::count(slot.begin(), slot.end(), nullptr) <= kLanes - kRunLanes) {
        add_slot(slot, row + distance);
        continue;
      }
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if (slot[lane] != nullptr) single[lane].push_back(slot[lane]);
      }
    }
    table_.run_end.push_back(slot_count());
    std::size_t most = 0;
    for (const auto& lane : single) most = std::max(most, lane.size());
    for (std::size_t rank = 0; rank < most; ++rank) {
      Slot slot{};
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if (rank < single[lane].size()) slot[lane] = single[lane][rank];
      }
      add_slot(slot, row);
    }
    table_.begin.push_back(slot_count());
  }

 private:
  [[nodiscard]] std::uint32_t slot_count() const { return static_cast<std::uint32_t>(table_.first.size()); }

  void add_slot(const Slot& slot, std::int32_t first) {
    table_.first.push_back(first);
    const VertexId any = (*std::ranges::find_if(slot, [](const auto* found) { return found != nullptr; }))->vertex;
    for (const LaneNeighbour* neighbour : slot) {
      table_.neighbour.push_back(neighbour != nullptr ? neighbour->vertex : any);
      table_.item.push_back(neighbour != nullptr ? neighbour->item : LaneTable::kNone);
    }
  }

  LaneTable& table_;
};

}  // namespace

std::vector<double> LaneTable::spread(const std::vector<double>& values) const {
  std::vector<double> entries;
  entries.reserve(item.size());
  for (const std::int32_t i : item) entries.push_back(i == kNone ? 0 : values[static_cast<std::size_t>(i)]);
  return entries;
}

LaneTable make_lane_table(const std::vector<std::vector<LaneNeighbour>>& neighbours) {
  LaneTable table;
  TableBuilder builder(table);
  const std::span all(neighbours);
  for (std::size_t row = 0; row < all.size(); row += kLanes) {
    builder.add_block(static_cast<VertexId>(row), all.subspan(row, std::min<std::size_t>(kLanes, all.size() - row)));
  }
  return table;
}

}  // namespace selvage::sim
