// A 5 by 7 pixel font with the characters of the labels: digits, the point, and the letters of "frame" and "s".
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "io/format/png.h"

namespace selvage::cli {

/// Draws `text` with its upper left corner at (x, y), every font pixel as scale by scale pixels, 6 font pixels a
/// character. A character that the font does not have is a filled box; what leaves the picture is cut off.
void draw_text(io::Picture& picture, int x, int y, int scale, std::string_view text,
               const std::array<std::uint8_t, 3>& rgb);

}  // namespace selvage::cli
