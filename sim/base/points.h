// Positions as files and the exact checker take them.
#pragma once

#include <string>
#include <string_view>

#include "io/mesh_data.h"
#include "kernel/types.h"

namespace selvage::sim {

/// The same bits, row by row.
[[nodiscard]] io::Points points_of(const Positions& x);

/// Throws io::Error, which names the first vertex, where the kernel could not answer: beyond kMaxCoordinate.
void require_in_domain(const io::Points& points, const std::string& name);

/// The memory of the coordinates, row by row; as long as `x` is.
[[nodiscard]] inline std::string_view bytes_of(const Positions& x) {
  return {reinterpret_cast<const char*>(x.data()), static_cast<std::size_t>(x.size()) * sizeof(double)};
}

/// Bit for bit, so that a position that is no number equals itself.
[[nodiscard]] bool same_bits(const Positions& a, const Positions& b);

}  // namespace selvage::sim
