// The few elements that a picture is drawn with.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "page/html.h"

namespace selvage::cli::plot {

/// Places are pixels from the left and from the top.
[[nodiscard]] page::Html line(double x0, double y0, double x1, double y1, std::string_view colour, double width = 1);
[[nodiscard]] page::Html rectangle(double x, double y, double width, double height, std::string_view colour);
/// `more` is a title() or nothing.
[[nodiscard]] page::Html path(std::string_view data, std::string_view fill, std::string_view stroke,
                              const page::Html& more = {});
/// A broken line along the path, for what is not measured.
[[nodiscard]] page::Html guide(std::string_view data);
/// "12.5"; never "-0.0".
[[nodiscard]] std::string pixels(double length);

enum class Anchor { kStart, kMiddle, kEnd };

struct Words {
  Anchor anchor = Anchor::kStart;
  double size = 12;
  std::string_view colour = "#333333";
  bool is_bold = false, is_upright = false;         ///< upright: read from below
  std::size_t most = static_cast<std::size_t>(-1);  ///< characters; what is longer is cut, and shown in full on hover
};
[[nodiscard]] page::Html words(double x, double y, std::string_view text, const Words& style);

/// What a browser shows where the mouse rests on the element that holds it.
[[nodiscard]] page::Html title(std::string_view text);

/// The number of characters of text that may not be UTF-8.
[[nodiscard]] std::size_t character_count(std::string_view text);
/// The width of `characters` of the given size, about: no font is known here.
[[nodiscard]] constexpr double width_of(std::size_t characters, double size) {
  return 0.58 * size * static_cast<double>(characters);
}

}  // namespace selvage::cli::plot
