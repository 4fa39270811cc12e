#include <cstdint>
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

}  // namespace selvage::cli
