#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "cli/plot/panels.h"
#include "cli/plot/scale.h"
#include "cli/plot/svg.h"

namespace selvage::cli::plot {

using page::Html;

void Curves::add(const std::string& name, Point point, bool has_line) {
  auto found = std::ranges::find(series, name, &Series::name);
  if (found == series.end()) found = series.insert(found, {name, {}, has_line});
  found->points.push_back(std::move(point));
}

Html draw(const Curves& curves, const Legend& legend, const Box& box) {
  std::vector<double> xs, ys;
  for (const Series& series : curves.series) {
    for (const Point& point : series.points) {
      xs.push_back(point.x);
      ys.push_back(point.y);
    }
  }
  const double left = box.x + 66, right = box.x + box.width - 14, top = box.y + 12, bottom = box.y + box.height - 44;
  const Scale x(curves.x.kind, xs, left + 6, right), y(curves.y.kind, ys, bottom - 6, top);
  Html drawn;
  for (const Tick& tick : x.ticks()) {
    const double at = x.place(tick.value);
    drawn += line(at, top, at, bottom, kGrid) +
             words(at, bottom + 16, tick.label, {.anchor = Anchor::kMiddle, .size = 11, .colour = kQuiet});
  }
  for (const Tick& tick : y.ticks()) {
    const double at = y.place(tick.value);
    drawn += line(left, at, right, at, kGrid) +
             words(left - 6, at + 4, tick.label, {.anchor = Anchor::kEnd, .size = 11, .colour = kQuiet});
  }
  drawn += line(left, bottom, right, bottom, kQuiet) + line(left, top, left, bottom, kQuiet);
  drawn += words((left + right) / 2, bottom + 35, curves.x.label, {.anchor = Anchor::kMiddle});
  drawn += words(box.x + 14, (top + bottom) / 2, curves.y.label, {.anchor = Anchor::kMiddle, .is_upright = true});
  for (const Series& series : curves.series) {
    std::string data;
    for (const Point& point : series.points) {
      data += fmt::format("{}{} {}", data.empty() ? "M" : " L", pixels(x.place(point.x)), pixels(y.place(point.y)));
    }
    if (series.has_line && series.points.size() > 1) drawn += path(data, "none", legend.colour(series.name));
  }
  for (const Series& series : curves.series) {
    for (const Point& point : series.points) {
      drawn += legend.marker(series.name, x.place(point.x), y.place(point.y),
                             title(fmt::format("{}\n{}", series.name, point.row)));
    }
  }
  return drawn;
}

}  // namespace selvage::cli::plot
