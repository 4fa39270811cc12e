// Writes an RGB picture as PNG (zlib).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "io/error.h"

namespace selvage::io {

struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgb;  ///< height rows of width pixels of 3 bytes, top row first
};

/// Throws Error(kBadInput) unless the sides are 1 to 65536 and the pixels fill them.
[[nodiscard]] std::string png_bytes(const Picture& picture);
void write_png(const std::filesystem::path& file, const Picture& picture);

}  // namespace selvage::io
