#include "cli/render/bitmap_font.h"

#include <algorithm>

namespace selvage::cli {
namespace {

constexpr int kRows = 7, kColumns = 5, kAdvance = 6;

struct Glyph {
  char character;
  std::array<const char*, kRows> rows;
};

constexpr Glyph kGlyphs[] = {
    {' ', {".....", ".....", ".....", ".....", ".....", ".....", "....."}},
    {'-', {".....", ".....", ".....", "#####", ".....", ".....", "....."}},
    {'.', {".....", ".....", ".....", ".....", ".....", ".##..", ".##.."}},
    {'0', {".###.", "#...#", "#..##", "#.#.#", "##..#", "#...#", ".###."}},
    {'1', {"..#..", ".##..", "..#..", "..#..", "..#..", "..#..", ".###."}},
    {'2', {".###.", "#...#", "....#", "...#.", "..#..", ".#...", "#####"}},
    {'3', {"####.", "....#", "....#", ".###.", "....#", "....#", "####."}},
    {'4', {"...#.", "..##.", ".#.#.", "#..#.", "#####", "...#.", "...#."}},
    {'5', {"#####", "#....", "####.", "....#", "....#", "#...#", ".###."}},
    {'6', {"..##.", ".#...", "#....", "####.", "#...#", "#...#", ".###."}},
    {'7', {"#####", "....#", "...#.", "..#..", ".#...", ".#...", ".#..."}},
    {'8', {".###.", "#...#", "#...#", ".###.", "#...#", "#...#", ".###."}},
    {'9', {".###.", "#...#", "#...#", ".####", "....#", "...#.", ".##.."}},
    {'a', {".....", ".....", ".###.", "....#", ".####", "#...#", ".####"}},
    {'e', {".....", ".....", ".###.", "#...#", "#####", "#....", ".###."}},
    {'f', {"..##.", ".#...", "####.", ".#...", ".#...", ".#...", ".#..."}},
    {'m', {".....", ".....", "##.#.", "#.#.#", "#.#.#", "#.#.#", "#.#.#"}},
    {'r', {".....", ".....", "#.##.", "##...", "#....", "#....", "#...."}},
    {'s', {".....", ".....", ".####", "#....", ".###.", "....#", "####."}},
};
constexpr Glyph kUnknown = {'\0', {"#####", "#####", "#####", "#####", "#####", "#####", "#####"}};

const Glyph& glyph_of(char character) {
  const auto* found = std::find_if(std::begin(kGlyphs), std::end(kGlyphs),
                                   [&](const Glyph& glyph) { return glyph.character == character; });
  return found == std::end(kGlyphs) ? kUnknown : *found;
}

void fill_square(io::Picture& picture, int left, int top, int side, const std::array<std::uint8_t, 3>& rgb) {
  for (int y = std::max(0, top); y < std::min(picture.height, top + side); ++y) {
    for (int x = std::max(0, left); x < std::min(picture.width, left + side); ++x) {
      std::copy(rgb.begin(), rgb.end(), picture.rgb.begin() + (std::ptrdiff_t{y} * picture.width + x) * 3);
    }
  }
}

}  // namespace

void draw_text(io::Picture& picture, int x, int y, int scale, std::string_view text,
               const std::array<std::uint8_t, 3>& rgb) {
  for (const char character : text) {
    const Glyph& glyph = glyph_of(character);
    for (int row = 0; row < kRows; ++row) {
      for (int column = 0; column < kColumns; ++column) {
        if (glyph.rows[static_cast<std::size_t>(row)][column] != '#') continue;
        fill_square(picture, x + column * scale, y + row * scale, scale, rgb);
      }
    }
    x += kAdvance * scale;
  }
}

}  // namespace selvage::cli
