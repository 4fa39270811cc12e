// Draws one panel into its box.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cli/plot/figure.h"
#include "page/html.h"

namespace selvage::cli::plot {

struct Box {
  double x = 0, y = 0, width = 0, height = 0;
};

inline constexpr std::string_view kGrid = "#e4e4e4", kInk = "#333333", kQuiet = "#666666", kOurs = "#0072B2",
                                  kOthers = "#9aa5ad", kPale = "#c3d9e8", kReference = "#a8a8a8", kBad = "#c62828";

/// What tells the series of a figure apart: the place of a name among its `names`.
class Legend {
 public:
  explicit Legend(const Figure& figure);

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  /// Of guides, which have neither a colour nor a marker.
  [[nodiscard]] const std::vector<std::string>& guides() const { return guides_; }
  [[nodiscard]] std::string_view colour(std::string_view name) const;
  /// A marker in the series' colour.
  [[nodiscard]] page::Html marker(std::string_view name, double x, double y, const page::Html& more = {}) const;

 private:
  [[nodiscard]] std::size_t index(std::string_view name) const;

  std::vector<std::string> names_, guides_;
};

[[nodiscard]] page::Html draw(const Curves& curves, const Legend& legend, const Box& box);
[[nodiscard]] page::Html draw(const Bars& bars, const Box& box);
/// The height that the panel needs.
[[nodiscard]] double height_of(const Bars& bars);

}  // namespace selvage::cli::plot
