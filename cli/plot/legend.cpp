#include <algorithm>
#include <iterator>

#include <fmt/format.h>

#include "cli/plot/panels.h"
#include "cli/plot/svg.h"

namespace selvage::cli::plot {
namespace {

// Colours that differ for colour-blind readers too (Okabe and Ito).
constexpr std::string_view kColours[] = {"#0072B2", "#D55E00", "#009E73", "#E69F00", "#CC79A7", "#000000", "#56B4E9"};
// Circle, square, triangle, rhombus, and the triangle upside down: with seven colours, 35 different series.
constexpr std::string_view kMarkers[] = {"m-4 0a4 4 0 1 0 8 0a4 4 0 1 0 -8 0z", "m-3.5 -3.5h7v7h-7z",
                                         "m0 -4.5l4.5 8h-9z", "m0 -5l5 5l-5 5l-5 -5z", "m0 4.5l4.5 -8h-9z"};

}  // namespace

Legend::Legend(const Figure& figure) {
  for (const auto& panel : figure.panels) {
    const auto* const curves = std::get_if<Curves>(&panel);
    if (curves == nullptr) continue;
    for (const Series& series : curves->series) {
      std::vector<std::string>& names = series.look == Look::kGuide ? guides_ : names_;
      if (std::ranges::find(names, series.name) == names.end()) names.push_back(series.name);
    }
  }
}

std::size_t Legend::index(std::string_view name) const {
  return static_cast<std::size_t>(std::ranges::find(names_, name) - names_.begin());
}

std::string_view Legend::colour(std::string_view name) const { return kColours[index(name) % std::size(kColours)]; }

page::Html Legend::marker(std::string_view name, double x, double y, const page::Html& more) const {
  const std::string data = fmt::format("M{} {}{}", pixels(x), pixels(y), kMarkers[index(name) % std::size(kMarkers)]);
  return path(data, colour(name), "#ffffff", more);
}

}  // namespace selvage::cli::plot
