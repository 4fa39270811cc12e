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

/// The clean sheets, or those with vertices pushed through, from the smallest up.
std::vector<const bench::VerifySheetReport*> ascending(const std::vector<bench::VerifySheetReport>& reports,
                                                       bool planted) {
  std::vector<const bench::VerifySheetReport*> sheets;
  for (const bench::VerifySheetReport& report : reports) {
    if (report.planted == planted) sheets.push_back(&report);
  }
  std::ranges::stable_sort(sheets, {}, &bench::VerifySheetReport::faces);
  return sheets;
}

struct Panels {
  plot::Curves processor, wall, memory, found, differ, exact;

  [[nodiscard]] std::vector<plot::Curves*> all() { return {&processor, &wall, &memory, &found, &differ, &exact}; }
};

Panels panels_of(const std::vector<const bench::VerifySheetReport*>& sheets) {
  const auto linear = plot::ScaleKind::kLinear;
  const plot::Axis faces{"faces of the sheet"};
  Panels panels{{faces, {"processor time a face, us"}, {}},
                {faces, {"wall time a face, us"}, {}},
                {faces, {"peak memory, bytes a face", linear}, {}},
                {faces, {"pairs found", linear}, {}},
                {faces, {"pairs that methods differ in", linear}, {}},
                {faces, {"share decided exactly"}, {}}};
  for (const bench::VerifySheetReport* const report : sheets) {
    const auto size = static_cast<double>(report->faces);
    for (const bench::VerifyMethodReport& method : report->methods) {
      const std::string name = series_name(method.name, method.thread_count);
      const std::string words = fmt::format(
          "{} faces, {} layers\n{:.3f} s of the processor, {:.3f} s on the wall, {:.3f} s to build\n{} found, {} "
          "differ; {} examined, {} exactly\n{:.1f} MiB",
          report->faces, report->layers, method.check.cpu * 1e-9, method.check.wall * 1e-9, method.build.cpu * 1e-9,
          method.found, method.missing + method.extra, method.examined, method.exact,
          static_cast<double>(method.peak_bytes) * 0x1p-20);
      panels.processor.add(name, {size, method.check.cpu * 1e-3 / size, words});
      panels.wall.add(name, {size, method.check.wall * 1e-3 / size, words});
      panels.memory.add(name, {size, static_cast<double>(method.peak_bytes) / size, words});
      panels.found.add(name, {size, static_cast<double>(method.found), words});
      panels.differ.add(name, {size, static_cast<double>(method.missing + method.extra), words});
      if (method.examined == 0) continue;
      panels.exact.add(name, {size, static_cast<double>(method.exact) / static_cast<double>(method.examined), words});
    }
  }
  return panels;
}

}  // namespace

plot::Figure figure_of(const std::vector<bench::VerifySheetReport>& reports) {
  Panels clean = panels_of(ascending(reports, false)), planted = panels_of(ascending(reports, true));
  const std::vector<plot::Curves*> above = clean.all(), below = planted.all();
  for (std::size_t i = 0; i < above.size(); ++i) plot::share_scales({above[i], below[i]});
  plot::Figure figure{"The exact checker on layered sheets: time, memory and what was found",
                      {"low is best, but for the pairs found; each method in a process of its own"},
                      3,
                      {plot::Heading{"Clean sheets"}}};
  for (plot::Curves* curves : above) figure.panels.emplace_back(std::move(*curves));
  figure.panels.emplace_back(plot::Heading{"20 vertices pushed through the next layer"});
  for (plot::Curves* curves : below) figure.panels.emplace_back(std::move(*curves));
  return figure;
}

}  // namespace selvage::cli
