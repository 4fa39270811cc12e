#include "cli/plot/room.h"

#include <algorithm>

#include "cli/plot/svg.h"

namespace selvage::cli::plot {
namespace {

constexpr double kSize = 9.5, kHalfMarker = 5;

bool overlap(const Box& a, const Box& b) {
  return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

bool is_inside(const Box& inner, const Box& outer) {
  return inner.x >= outer.x && inner.x + inner.width <= outer.x + outer.width && inner.y >= outer.y &&
         inner.y + inner.height <= outer.y + outer.height;
}

}  // namespace

void Room::take_marker(double x, double y) {
  taken_.push_back({x - kHalfMarker, y - kHalfMarker, 2 * kHalfMarker, 2 * kHalfMarker});
}

bool Room::is_free(const Box& box) const {
  return is_inside(box, panel_) && std::ranges::none_of(taken_, [&](const Box& other) { return overlap(box, other); });
}

page::Html Room::label(double x, double y, std::string_view text, std::string_view colour) {
  const double width = width_of(character_count(text), kSize) + 4, right = x + kHalfMarker + 1,
               left = x - kHalfMarker - 1 - width, above = y - kHalfMarker - 1 - kSize, beside = y - kSize / 2,
               below = y + kHalfMarker + 1;
  const Box places[] = {{right, beside, width, kSize}, {right, above, width, kSize}, {right, below, width, kSize},
                        {left, beside, width, kSize},  {left, above, width, kSize},  {left, below, width, kSize}};
  const auto* const place = std::ranges::find_if(places, [&](const Box& box) { return is_free(box); });
  if (place == std::end(places)) return {};
  taken_.push_back(*place);
  return words(place->x, place->y + 0.85 * kSize, text, {.size = kSize, .colour = colour});
}

}  // namespace selvage::cli::plot
