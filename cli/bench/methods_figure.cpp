#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/bench/bench_figures.h"

namespace selvage::cli {
namespace {

double share(std::int64_t part, std::int64_t whole) {
  return static_cast<double>(part) / static_cast<double>(std::max<std::int64_t>(1, whole));
}

/// Labels the two ends of every line alone, so that one sees which is which, and only where they are apart.
void label_ends(plot::Curves& curves) {
  for (plot::Series& series : curves.series) {
    const auto [low, high] = std::minmax(series.points.front().y, series.points.back().y);
    for (std::size_t i = 0; i < series.points.size(); ++i) {
      const bool is_end = i == 0 || i + 1 == series.points.size();
      if (!is_end || high <= 3 * low) series.points[i].label.clear();
    }
  }
}

struct SetPanels {
  plot::Heading heading;
  plot::Curves missed, alarms, off;
};

SetPanels panels_of(const bench::SetReport& report) {
  const plot::Axis time{
      .label = fmt::format("time a query, multiple of {} {}", bench::kBaselineMethod, bench::kBaselineSetting),
      .reference = 1};
  const auto error = [](const char* label) { return plot::Axis{.label = label, .holds = {0, 0.001, 1}}; };
  SetPanels panels{{fmt::format("{} ({}): {} vf + {} ee, {} touch", report.name, report.what, report.vf, report.ee,
                                report.touching)},
                   {time, error("missed, share of what touches"), {}},
                   {time, error("false alarms, share of the others"), {}},
                   {time, error("toi off by (p99), share of step"), {}}};
  for (const bench::SettingReport& row : report.settings) {
    const std::string words = fmt::format(
        "{}: {} missed, {} false alarms, {} gave up\n{} late, by {:.1e}; early p50 {:.1e}, p99 {:.1e}\n"
        "{:.0f} ns, {:.2f} of the baseline",
        row.setting, row.misses, row.false_alarms, row.gave_up, row.toi.late, row.toi.late_max, row.toi.early_median,
        row.toi.early_p99, row.ns, row.ratio);
    const std::string label = row.setting.substr(0, row.setting.find(" of "));
    panels.missed.add(row.method, {row.ratio, share(row.misses, report.touching), words, label});
    panels.alarms.add(row.method,
                      {row.ratio, share(row.false_alarms, report.vf + report.ee - report.touching), words, label});
    if (row.toi_examined > 0) panels.off.add(row.method, {row.ratio, row.toi_off_p99, words, label});
  }
  for (plot::Curves* curves : {&panels.missed, &panels.alarms, &panels.off}) label_ends(*curves);
  return panels;
}

}  // namespace

plot::Figure figure_of(const std::vector<bench::SetReport>& reports) {
  std::vector<SetPanels> sets;
  for (const bench::SetReport& report : reports) sets.push_back(panels_of(report));
  for (plot::Curves SetPanels::*const column : {&SetPanels::missed, &SetPanels::alarms, &SetPanels::off}) {
    std::vector<plot::Curves*> panels;
    for (SetPanels& set : sets) panels.push_back(&(set.*column));
    plot::share_scales(panels);
  }
  plot::Figure figure{
      "Methods of collision detection: errors against time",
      {"left and low is best; a point a setting; one thread; the exact checker says the truth",
       "toi: time of impact, early or late, where a contact was found; panels below each other have the "
       "same axes"},
      3,
      {}};
  for (SetPanels& set : sets) {
    figure.panels.emplace_back(std::move(set.heading));
    for (plot::Curves* curves : {&set.missed, &set.alarms, &set.off}) figure.panels.emplace_back(std::move(*curves));
  }
  return figure;
}

}  // namespace selvage::cli
