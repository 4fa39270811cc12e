#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/bench/bench_figures.h"
#include "cli/bench/series_name.h"

namespace selvage::cli {
namespace {

using Motions = std::vector<const bench::BroadMotionReport*>;

double pairs_of(const bench::BroadMotionReport& report) { return static_cast<double>(report.vf + report.ee); }

double share_of_pairs(double of, const bench::BroadMotionReport& report) {
  return of / std::max(1.0, pairs_of(report));
}

double pairs_a_face(const bench::BroadMotionReport& report) {
  return pairs_of(report) / static_cast<double>(report.faces);
}

std::string words_of(const bench::BroadMotionReport& report) {
  return fmt::format("{}, {} faces, {} candidates", report.motion, report.faces, report.vf + report.ee);
}

/// Refit and query, in processor time; where there is no refit, what is built again.
double detection_ns(const bench::BroadMethodReport& method) {
  return (method.refit.cpu > 0 ? method.refit.cpu : method.build.cpu) + method.query.cpu;
}

/// Against the faces: a motion a line.
void add_methods(plot::Figure& figure, const Motions& motions, int thread_count) {
  const plot::Axis faces{"faces"};
  plot::Curves processor{faces, {"refit and query, ns a pair (cpu)"}, {}},
      wall{faces, {"query, ns a pair (on the wall)"}, {}},
      wrong{faces, {.label = "pairs missing or extra, share", .holds = {0, 0.001, 1}}, {}};
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const bench::BroadMotionReport& report = *motions[i];
    const bool is_first = i == 0 || motions[i - 1]->motion != report.motion;
    const auto size = static_cast<double>(report.faces);
    for (const bench::BroadMethodReport& method : report.methods) {
      if (method.thread_count != thread_count) continue;
      const std::string words = fmt::format(
          "{}\nbuild {:.1f} ms, refit {:.1f} ms, query {:.1f} ms, on the wall {:.1f} ms\n{} pairs missing, {} extra",
          words_of(report), method.build.cpu * 1e-6, method.refit.cpu * 1e-6, method.query.cpu * 1e-6,
          method.query.wall * 1e-6, method.missing, method.extra);
      const auto add = [&](plot::Curves& curves, double y) { curves.add(method.name, {size, y, words, "", is_first}); };
      add(processor, share_of_pairs(detection_ns(method), report));
      add(wall, share_of_pairs(method.query.wall, report));
      add(wrong, share_of_pairs(static_cast<double>(method.missing + method.extra), report));
    }
  }
  figure.panels.emplace_back(plot::Heading{threads_name(thread_count)});
  for (plot::Curves* curves : {&processor, &wall, &wrong}) figure.panels.emplace_back(std::move(*curves));
}

/// How many pairs the motions have.
plot::Curves pairs_panel(const Motions& motions) {
  plot::Curves curves{{"faces"}, {"candidate pairs a face", plot::ScaleKind::kLinear}, {}};
  for (const bench::BroadMotionReport* const report : motions) {
    curves.add(report->motion, {static_cast<double>(report->faces), pairs_a_face(*report), words_of(*report)});
  }
  return curves;
}

/// What a pair costs where more of them come on a face: a number of faces a line.
plot::Curves crowding_panel(Motions motions, int thread_count) {
  std::ranges::stable_sort(motions, {}, [](const auto* report) { return std::pair(report->faces, pairs_of(*report)); });
  plot::Curves curves{{"candidate pairs a face"}, {"refit and query, ns a pair (cpu)"}, {}};
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const bench::BroadMotionReport& report = *motions[i];
    const bool is_first = i == 0 || motions[i - 1]->faces != report.faces;
    for (const bench::BroadMethodReport& method : report.methods) {
      if (method.thread_count != thread_count) continue;
      curves.add(method.name,
                 {pairs_a_face(report), share_of_pairs(detection_ns(method), report), words_of(report), "", is_first});
    }
  }
  return curves;
}

/// Detection among some moved vertices.
plot::Curves moved_panel(const Motions& motions) {
  plot::Curves curves{{"vertices that moved"}, {"refit and query, ms (cpu)"}, {}};
  for (const bench::BroadMotionReport* const report : motions) {
    for (const bench::BroadIncrementalReport& row : report->incremental) {
      curves.add(
          row.spread + " moved",
          {static_cast<double>(row.active_vertices), (row.refit.cpu + row.query.cpu) * 1e-6,
           fmt::format("{}\n{} vertices moved: {} candidates, refit {:.1f} ms, query {:.2f} ms", words_of(*report),
                       row.active_vertices, row.candidates, row.refit.cpu * 1e-6, row.query.cpu * 1e-6)},
          plot::Look::kMarkers);
    }
  }
  return curves;
}

template <typename T>
void add_once(std::vector<T>& list, const T& value) {
  if (std::ranges::find(list, value) == list.end()) list.push_back(value);
}

}  // namespace

plot::Figure figure_of(const std::vector<bench::BroadMotionReport>& reports) {
  Motions motions;
  std::int64_t sampled = 0, differences = 0;
  std::vector<int> thread_counts;
  for (const bench::BroadMotionReport& report : reports) {
    motions.push_back(&report);
    sampled += report.sampled;
    differences += report.differences;
    for (const bench::BroadMethodReport& method : report.methods) add_once(thread_counts, method.thread_count);
  }
  plot::Figure figure{"The broad phase: time and errors",
                      {fmt::format("low is best; {} features by brute force: {} differences; where a method has no "
                                   "refit it builds again",
                                   sampled, differences)},
                      3,
                      {}};
  for (const int thread_count : thread_counts) add_methods(figure, motions, thread_count);
  figure.panels.emplace_back(
      plot::Heading{fmt::format("Candidate pairs of the motions, what they cost where they are many ({}), and "
                                "detection where few vertices move (1 thread)",
                                threads_name(thread_counts.front()))});
  figure.panels.emplace_back(pairs_panel(motions));
  figure.panels.emplace_back(crowding_panel(motions, thread_counts.front()));
  figure.panels.emplace_back(moved_panel(motions));
  return figure;
}

}  // namespace selvage::cli
