// What mesh files hold, as a scene takes it: in metres, and with its errors at the line of the scene that names them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "io/error.h"
#include "io/mesh_data.h"
#include "kernel/types.h"

namespace selvage::sim {

/// #V by 3, m. Throws io::Error where a coordinate is beyond kCoordinate (scene_ranges.h); `name` is how it calls the
/// mesh.
[[nodiscard]] Positions scaled_positions(const io::Points& points, double scale, std::string_view name);

/// read(), with "SCENE:LINE: WHAT: " before what an io::Error says.
template <class Read>
auto read_for_line(const std::filesystem::path& scene_file, std::size_t line, std::string_view what, const Read& read) {
  try {
    return read();
  } catch (const io::Error& error) {
    throw io::Error(error.kind(), fmt::format("{}:{}: {}: {}", scene_file.string(), line, what, error.what()));
  }
}

}  // namespace selvage::sim
