#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "bench/guest_method.h"
#include "cli/bench/bench_figures.h"
#include "cli/plot/scale.h"

namespace selvage::cli {

using plot::number_label;

namespace {

plot::Cell unsafe_count(std::int64_t count) { return {std::to_string(count), count > 0}; }

std::string guest_label(const std::string& method, const std::optional<bench::GuestFacts>& guest) {
  return guest && method == bench::kGuestRow ? fmt::format("{} {}", method, guest->name) : method;
}

double share(std::int64_t part, std::int64_t whole) {
  return static_cast<double>(part) / static_cast<double>(std::max<std::int64_t>(1, whole));
}

}  // namespace

plot::Figure figure_of(const bench::QueryBenchReport& report) {
  plot::Bars bars{{"processor time a query, ns (best pass)"},
                  {"mean ns", "p99 ns", "missed", "false", "unresolved", "late toi", "early p99"},
                  {}};
  for (const bench::MethodReport& method : report.methods) {
    const auto toi = [&](const plot::Cell& cell) { return method.gives_toi ? cell : plot::Cell{"-"}; };
    bars.bars.push_back({guest_label(method.name, report.guest),
                         method.ns.mean,
                         {{number_label(method.ns.mean)},
                          {number_label(method.ns.p99)},
                          unsafe_count(method.false_negatives),
                          {std::to_string(method.false_positives)},
                          {std::to_string(method.unresolved)},
                          toi(unsafe_count(method.toi.late)),
                          toi({number_label(method.toi.early_p99)})},
                         method.name == "kernel"});
  }
  return {"Collision queries: time and errors",
          {fmt::format("{}", fmt::join(report.files, ", ")),
           fmt::format("{} queries, {} with a contact; truth from the files for {}, from the exact checker for {}; {} "
                       "contradicted",
                       report.queries, report.positives, report.truth_in_files, report.queries - report.truth_in_files,
                       report.contradicted.size()),
           "one thread; times of impact (toi) in parts of the step; red: what no collision code may do"},
          1,
          {std::move(bars)}};
}

plot::Figure figure_of(const bench::CcdBenchReport& report) {
  plot::Bars bars{{"processor time a candidate, ns (best pass)"},
                  {"mean ns", "/textbook", "missed", "false", "beyond gap", "unresolved", "late toi", "early p99"},
                  {}};
  for (const bench::CcdMethodReport& method : report.methods) {
    const auto toi = [&](const plot::Cell& cell) { return method.toi_examined > 0 ? cell : plot::Cell{"-"}; };
    bars.bars.push_back({guest_label(method.name, report.guest),
                         method.ns_mean,
                         {{number_label(method.ns_mean)},
                          {number_label(method.ratio)},
                          unsafe_count(method.false_negatives),
                          {std::to_string(method.false_positives)},
                          {std::to_string(method.false_positives_beyond_gap)},
                          {std::to_string(method.unresolved)},
                          toi(unsafe_count(method.toi.late)),
                          toi({number_label(method.toi.early_p99)})},
                         method.name.starts_with("kernel")});
  }
  return {"All candidates of a motion: time and errors",
          {report.motion,
           fmt::format("{} vertices, {} faces; candidates {} vf + {} ee; contacts {} vf + {} ee, by the exact checker; "
                       "{} verdicts published, {} contradicted",
                       report.vertices, report.faces, report.vf_candidates, report.ee_candidates, report.vf_contacts,
                       report.ee_contacts, report.labels, report.labels_contradicted),
           "one thread; times of impact (toi) in parts of the step; red: what no collision code may do"},
          1,
          {std::move(bars)}};
}

plot::Figure figure_of(const std::vector<bench::SetReport>& reports) {
  plot::Figure figure{"Methods of collision detection: errors against time",
                      {"left and low is best; a point a setting; one thread; the exact checker says the truth"},
                      3,
                      {}};
  const plot::Axis time{
      fmt::format("time a query, multiple of {} {}", bench::kBaselineMethod, bench::kBaselineSetting)};
  for (const bench::SetReport& report : reports) {
    plot::Curves missed{time, {"missed, share of what touches"}, {}},
        alarms{time, {"false alarms, share of the others"}, {}}, off{time, {"toi off by (p99), share of the step"}, {}};
    for (const bench::SettingReport& row : report.settings) {
      const std::string words = fmt::format(
          "{}: {} missed, {} false alarms, {} gave up\n{} late, by {:.1e}; early p50 {:.1e}, p99 {:.1e}\n{:.0f} ns, "
          "{:.2f} "
          "of the baseline",
          row.setting, row.misses, row.false_alarms, row.gave_up, row.toi.late, row.toi.late_max, row.toi.early_median,
          row.toi.early_p99, row.ns, row.ratio);
      missed.add(row.method, {row.ratio, share(row.misses, report.touching), words});
      alarms.add(row.method, {row.ratio, share(row.false_alarms, report.vf + report.ee - report.touching), words});
      if (row.toi_examined > 0) off.add(row.method, {row.ratio, row.toi_off_p99, words});
    }
    figure.panels.emplace_back(plot::Heading{fmt::format("{} ({}): {} vf + {} ee, {} touch", report.name, report.what,
                                                         report.vf, report.ee, report.touching)});
    for (plot::Curves* curves : {&missed, &alarms, &off}) figure.panels.emplace_back(std::move(*curves));
  }
  return figure;
}

}  // namespace selvage::cli
