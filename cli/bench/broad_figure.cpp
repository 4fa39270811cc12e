#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/bench/bench_figures.h"
#include "cli/bench/series_name.h"

namespace selvage::cli {

plot::Figure figure_of(const std::vector<bench::BroadMotionReport>& reports) {
  const plot::Axis candidates{"candidate pairs of the motion"};
  plot::Curves processor{candidates, {"refit and query, processor time, ms"}, {}},
      wall{candidates, {"query, wall time, ms"}, {}}, wrong{candidates, {"pairs missing or extra, share"}, {}},
      moved{{"vertices that moved"}, {"refit and query, processor time, ms"}, {}};
  std::vector<const bench::BroadMotionReport*> ascending;  // so that lines go from left to right
  for (const bench::BroadMotionReport& report : reports) ascending.push_back(&report);
  std::ranges::stable_sort(ascending, {}, [](const auto* report) { return report->vf + report->ee; });
  for (const bench::BroadMotionReport* report : ascending) {
    const auto count = static_cast<double>(report->vf + report->ee);
    const std::string motion = fmt::format("{}, {} faces", report->motion, report->faces);
    for (const bench::BroadMethodReport& method : report->methods) {
      const std::string name = series_name(method.name, method.thread_count);
      const std::string words = fmt::format(
          "{}\nbuild {:.1f} ms, refit {:.1f} ms, query {:.1f} ms, on the wall {:.1f} ms\n{} pairs missing, {} extra",
          motion, method.build.cpu * 1e-6, method.refit.cpu * 1e-6, method.query.cpu * 1e-6, method.query.wall * 1e-6,
          method.missing, method.extra);
      const double refit =
          method.refit.cpu > 0 ? method.refit.cpu : method.build.cpu;  // again, where there is no other
      processor.add(name, {count, (refit + method.query.cpu) * 1e-6, words});
      wall.add(name, {count, method.query.wall * 1e-6, words});
      wrong.add(name, {count, static_cast<double>(method.missing + method.extra) / std::max(1.0, count), words});
    }
    for (const bench::BroadIncrementalReport& row : report->incremental) {
      moved.add(row.spread + " moved",
                {static_cast<double>(row.active_vertices), (row.refit.cpu + row.query.cpu) * 1e-6,
                 fmt::format("{}\n{} vertices moved: {} candidates, refit {:.1f} ms, query {:.2f} ms", motion,
                             row.active_vertices, row.candidates, row.refit.cpu * 1e-6, row.query.cpu * 1e-6)},
                false);
    }
  }
  std::int64_t sampled = 0, differences = 0;
  std::vector<std::string> names;
  for (const bench::BroadMotionReport& report : reports) {
    sampled += report.sampled;
    differences += report.differences;
    if (std::ranges::find(names, report.motion) == names.end()) names.push_back(report.motion);
  }
  plot::Figure figure{"The broad phase: time and errors", std::move(names), 2, {}};
  figure.notes.push_back(fmt::format(
      "low is best; {} features by brute force: {} differences; where a method has no refit it builds again", sampled,
      differences));
  for (plot::Curves* curves : {&processor, &wall, &wrong, &moved}) figure.panels.emplace_back(std::move(*curves));
  return figure;
}

}  // namespace selvage::cli
