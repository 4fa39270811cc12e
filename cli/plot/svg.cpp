#include "cli/plot/svg.h"

#include <algorithm>

#include <fmt/format.h>

#include "page/utf8.h"

namespace selvage::cli::plot {

using page::element;
using page::Html;

namespace {

/// The bytes of the first `count` characters.
std::size_t length_of(std::string_view text, std::size_t count) {
  std::size_t length = 0;
  for (; count > 0 && length < text.size(); --count) {
    length += std::max<std::size_t>(1, page::character_length(text.substr(length)));
  }
  return length;
}

}  // namespace

std::string pixels(double length) {
  const std::string text = fmt::format("{:.1f}", length);
  return text == "-0.0" ? "0.0" : text;
}

Html line(double x0, double y0, double x1, double y1, std::string_view colour, double width) {
  return element("line",
                 {{"x1", pixels(x0)},
                  {"y1", pixels(y0)},
                  {"x2", pixels(x1)},
                  {"y2", pixels(y1)},
                  {"stroke", colour},
                  {"stroke-width", pixels(width)}},
                 {}) +
         Html{"\n"};
}

Html rectangle(double x, double y, double width, double height, std::string_view colour) {
  return element("rect",
                 {{"x", pixels(x)},
                  {"y", pixels(y)},
                  {"width", pixels(width)},
                  {"height", pixels(height)},
                  {"fill", colour}},
                 {}) +
         Html{"\n"};
}

Html path(std::string_view data, std::string_view fill, std::string_view stroke, const Html& more) {
  return element("path", {{"d", data}, {"fill", fill}, {"stroke", stroke}}, more) + Html{"\n"};
}

Html guide(std::string_view data) {
  return element("path", {{"d", data}, {"fill", "none"}, {"stroke", "#777777"}, {"stroke-dasharray", "2 3"}}, {}) +
         Html{"\n"};
}

Html title(std::string_view text) { return element("title", {}, page::text(text)); }

std::size_t character_count(std::string_view text) {
  std::size_t count = 0;
  for (std::size_t at = 0; at < text.size(); ++count) at += length_of(text.substr(at), 1);
  return count;
}

Html words(double x, double y, std::string_view text, const Words& style) {
  constexpr std::string_view kAnchors[] = {"start", "middle", "end"};
  const std::string place =
      fmt::format("translate({} {}){}", pixels(x), pixels(y), style.is_upright ? " rotate(-90)" : "");
  Html content;
  if (character_count(text) > style.most) {
    content = title(text) + page::text(text.substr(0, length_of(text, style.most - 1))) + page::text("…");
  } else {
    content = page::text(text);
  }
  return element("text",
                 {{"transform", place},
                  {"text-anchor", kAnchors[static_cast<int>(style.anchor)]},
                  {"font-size", pixels(style.size)},
                  {"font-weight", style.is_bold ? "bold" : "normal"},
                  {"fill", style.colour}},
                 content) +
         Html{"\n"};
}

}  // namespace selvage::cli::plot
