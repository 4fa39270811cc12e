#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cli/bench/bench_figures.h"
#include "cli/bench/series_name.h"

namespace selvage::cli {

plot::Figure figure_of(const std::vector<bench::VerifySheetReport>& reports) {
  const plot::Axis faces{"faces of the sheet"};
  plot::Curves processor{faces, {"processor time, s"}, {}}, wall{faces, {"wall time, s"}, {}},
      memory{faces, {"peak memory, MiB"}, {}}, found{faces, {"pairs found"}, {}},
      differ{faces, {"pairs that methods differ in"}, {}}, exact{faces, {"share decided exactly"}, {}};
  std::vector<const bench::VerifySheetReport*> ascending;
  for (const bench::VerifySheetReport& report : reports) ascending.push_back(&report);
  std::ranges::stable_sort(ascending, {}, &bench::VerifySheetReport::faces);
  for (const bench::VerifySheetReport* report : ascending) {
    const auto size = static_cast<double>(report->faces);
    for (const bench::VerifyMethodReport& method : report->methods) {
      const std::string name =
          series_name(method.name, method.thread_count) + (report->planted ? ", pushed through" : "");
      const std::string words = fmt::format(
          "{} faces, {} layers\n{:.3f} s of the processor, {:.3f} s on the wall, {:.3f} s to build\n{} found, {} "
          "differ; {} "
          "examined, {} exactly\n{:.1f} MiB",
          report->faces, report->layers, method.check.cpu * 1e-9, method.check.wall * 1e-9, method.build.cpu * 1e-9,
          method.found, method.missing + method.extra, method.examined, method.exact,
          static_cast<double>(method.peak_bytes) * 0x1p-20);
      processor.add(name, {size, method.check.cpu * 1e-9, words});
      wall.add(name, {size, method.check.wall * 1e-9, words});
      memory.add(name, {size, static_cast<double>(method.peak_bytes) * 0x1p-20, words});
      found.add(name, {size, static_cast<double>(method.found), words});
      differ.add(name, {size, static_cast<double>(method.missing + method.extra), words});
      if (method.examined == 0) continue;
      exact.add(name, {size, static_cast<double>(method.exact) / static_cast<double>(method.examined), words});
    }
  }
  plot::Figure figure{
      "The exact checker on layered sheets: time, memory and what was found",
      {"low is best; clean sheets, and with 20 vertices pushed through the next layer; each method in a "
       "process of its own"},
      3,
      {}};
  for (plot::Curves* curves : {&processor, &wall, &memory, &found, &differ, &exact}) {
    figure.panels.emplace_back(std::move(*curves));
  }
  return figure;
}

}  // namespace selvage::cli
