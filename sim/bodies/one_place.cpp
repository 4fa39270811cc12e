#include "sim/bodies/one_place.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "kernel/assert.h"

namespace selvage::sim {

void OnePlace::narrow(const Positions& x) {
  if (!has_frame_) {
    has_frame_ = true;
    first_.assign(static_cast<std::size_t>(x.rows()), 0);
    together_.resize(first_.size());
    std::iota(together_.begin(), together_.end(), 0);
  }
  SELVAGE_ASSERT(x.rows() == std::ssize(first_));
  const auto place = [&](VertexId v) {
    return std::tuple(first_[static_cast<std::size_t>(v)], x(v, 0), x(v, 1), x(v, 2));
  };
  std::ranges::sort(together_, {}, [&](VertexId v) { return std::tuple_cat(place(v), std::tuple(v)); });
  std::vector<VertexId> still;
  for (auto begin = together_.begin(); begin != together_.end();) {
    const auto end = std::find_if(begin, together_.end(), [&](VertexId v) { return place(v) != place(*begin); });
    if (end - begin > 1) still.insert(still.end(), begin, end);
    const VertexId lowest = *begin;
    for (; begin != end; ++begin) first_[static_cast<std::size_t>(*begin)] = lowest;
  }
  together_ = std::move(still);
}

}  // namespace selvage::sim
