#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "cli/plot/panels.h"
#include "cli/plot/room.h"
#include "cli/plot/scale.h"
#include "cli/plot/svg.h"

namespace selvage::cli::plot {

using page::Html;

void Curves::add(const std::string& name, Point point, Look look) {
  auto found = std::ranges::find(series, name, &Series::name);
  if (found == series.end()) found = series.insert(found, {name, {}, look});
  found->points.push_back(std::move(point));
}

namespace {

/// All numbers that the two axes are to show.
struct Shown {
  std::vector<double> xs, ys;

  void add(const Curves& curves) {
    xs.insert(xs.end(), curves.x.holds.begin(), curves.x.holds.end());
    ys.insert(ys.end(), curves.y.holds.begin(), curves.y.holds.end());
    for (const Series& series : curves.series) {
      for (const Point& point : series.points) {
        xs.push_back(point.x);
        ys.push_back(point.y);
      }
    }
  }
};

std::string lines_of(const Series& series, const Scale& x, const Scale& y) {
  std::string data;
  for (const Point& point : series.points) {
    if (!data.empty()) data += ' ';
    const bool starts = data.empty() || point.starts_line;
    data += fmt::format("{}{} {}", starts ? 'M' : 'L', pixels(x.place(point.x)), pixels(y.place(point.y)));
  }
  return data;
}

}  // namespace

void share_scales(const std::vector<Curves*>& panels) {
  Shown all;
  for (const Curves* const curves : panels) all.add(*curves);
  for (Curves* const curves : panels) {
    curves->x.holds = all.xs;
    curves->y.holds = all.ys;
  }
}

Html draw(const Curves& curves, const Legend& legend, const Box& box) {
  Shown shown;
  shown.add(curves);
  const double left = box.x + 66, right = box.x + box.width - 14, top = box.y + 12, bottom = box.y + box.height - 44;
  const Scale x(curves.x.kind, shown.xs, left + 6, right), y(curves.y.kind, shown.ys, bottom - 6, top);
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
  if (curves.x.reference) {
    const double at = x.place(*curves.x.reference);
    drawn += line(at, top, at, bottom, kReference, 1.5);
  }
  if (curves.y.reference) {
    const double at = y.place(*curves.y.reference);
    drawn += line(left, at, right, at, kReference, 1.5);
  }
  drawn += line(left, bottom, right, bottom, kQuiet) + line(left, top, left, bottom, kQuiet);
  drawn += words((left + right) / 2, bottom + 35, curves.x.label, {.anchor = Anchor::kMiddle});
  drawn += words(box.x + 11, (top + bottom) / 2, curves.y.label, {.anchor = Anchor::kMiddle, .is_upright = true});
  for (const Series& series : curves.series) {
    const std::string data = lines_of(series, x, y);
    if (series.look == Look::kGuide) {
      drawn += guide(data);
    } else if (series.look == Look::kLineAndMarkers && series.points.size() > 1) {
      drawn += path(data, "none", legend.colour(series.name));
    }
  }
  Room room({left, top - 8, right - left + 8, bottom - top + 8});
  for (const Series& series : curves.series) {
    if (series.look == Look::kGuide) continue;
    for (const Point& point : series.points) {
      drawn += legend.marker(series.name, x.place(point.x), y.place(point.y),
                             title(fmt::format("{}\n{}", series.name, point.row)));
      room.take_marker(x.place(point.x), y.place(point.y));
    }
  }
  for (const Series& series : curves.series) {
    for (const Point& point : series.points) {
      if (point.label.empty()) continue;
      drawn += room.label(x.place(point.x), y.place(point.y), point.label, legend.colour(series.name));
    }
  }
  return drawn;
}

}  // namespace selvage::cli::plot
