#include "cli/bench/bench_verify_command.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "bench/verify_bench.h"
#include "cli/answer/result.h"
#include "cli/arguments/list_option.h"
#include "cli/arguments/number_check.h"
#include "cli/arguments/output_check.h"
#include "cli/bench/bench_figures.h"
#include "cli/bench/bench_outputs.h"
#include "cli/command.h"
#include "cli/process/terminal.h"

namespace selvage::cli {
namespace {

struct VerifyBenchArguments {
  BenchOutputs outputs;
  bench::VerifyBenchOptions options;
};

std::string table(const bench::VerifySheetReport& report) {
  std::string text = fmt::format("{} faces, {} vertices, {} layers, {}\n", report.faces, report.vertices, report.layers,
                                 report.planted ? "20 vertices pushed through the next layer" : "clean");
  text +=
      fmt::format("  {:<7} {:>7} {:>8} {:>8} {:>9} {:>12} {:>7} {:>7} {:>6} {:>11} {:>9} {:>8}\n", "method", "threads",
                  "cpu s", "wall s", "build s", "faces / s", "/frame", "found", "differ", "examined", "exact %", "MiB");
  const auto is_frame = [](const auto& method) { return method.name == "frame"; };
  const auto frame = std::find_if(report.methods.begin(), report.methods.end(), is_frame);
  for (const bench::VerifyMethodReport& method : report.methods) {
    const double exact =
        100 * static_cast<double>(method.exact) / static_cast<double>(std::max<std::int64_t>(1, method.examined));
    text += fmt::format(
        "  {:<7} {:>7} {:>8.3f} {:>8.3f} {:>9.3f} {:>12.0f} {:>7.2f} {:>7} {:>6} {:>11} {:>9} {:>8.1f}\n", method.name,
        method.thread_count, method.check.cpu * 1e-9, method.check.wall * 1e-9, method.build.cpu * 1e-9,
        static_cast<double>(report.faces) / (method.check.wall * 1e-9), method.check.cpu / frame->check.cpu,
        method.found, method.missing + method.extra, method.examined > 0 ? fmt::format("{}", method.examined) : "-",
        method.examined > 0 ? fmt::format("{:.4f}", exact) : "-", static_cast<double>(method.peak_bytes) * 0x1p-20);
  }
  return text;
}

ExitCode bench_verify(const VerifyBenchArguments& arguments) {
  require_outputs({}, arguments.outputs.files());
  const bench::LoadedFrameRival rival = bench::load_frame_rival(bench::rivals_beside_program());
  if (!rival.create) say("selvage: without CGAL: {}\n", rival.absent);
  const std::vector<bench::VerifySheetReport> reports = bench::run_verify_bench(rival, arguments.options);
  for (const bench::VerifySheetReport& report : reports) print_result(table(report), arguments.outputs.files());
  print_result(fmt::format("each method in a process of its own; processor time of all threads and wall time, best of "
                           "{} passes; /frame: "
                           "processor time over that of the frame check in the same run\n",
                           arguments.options.repeat),
               arguments.outputs.files());
  if (!arguments.outputs.json.empty()) write_report(arguments.outputs.json, bench::to_json(reports, rival));
  if (!arguments.outputs.svg.empty()) write_report(arguments.outputs.svg, plot::to_svg(figure_of(reports)));
  const auto wrong = [](const bench::VerifySheetReport& report) { return bench::is_wrong(report); };
  return std::ranges::any_of(reports, wrong) ? ExitCode::kViolation : ExitCode::kClean;
}

}  // namespace

void add_bench_verify_command(CLI::App& bench, Job& job) {
  CLI::App& verify =
      add_command(bench, "verify",
                  "The exact frame check against CGAL's self_intersections, on generated layered sheets, "
                  "clean and with planted intersections. Exit code 1 if they find different pairs.",
                  "selvage bench verify --faces 50000,500000 --motion --json out.json");
  const auto arguments = std::make_shared<VerifyBenchArguments>();
  add_list(verify, "--faces", arguments->options.faces, "Faces of the sheets")
      ->check(whole_between(100, 20'000'000))
      ->capture_default_str();
  verify.add_option("--layers", arguments->options.layers, "Layers (default: 10 below 100,000 faces, 20 above)")
      ->check(whole_between(2, 1000));
  verify.add_flag("--motion", arguments->options.motion, "Measure the check of the motion between two frames too");
  add_list(verify, "--threads", arguments->options.thread_counts, "Numbers of threads")
      ->check(whole_between(1, 1024))
      ->capture_default_str();
  verify.add_option("--repeat", arguments->options.repeat, "Timed passes")
      ->check(whole_between(1, 10000))
      ->capture_default_str();
  add_outputs(verify, arguments->outputs);
  verify.callback([arguments, &job] { job = [arguments] { return bench_verify(*arguments); }; });
}

}  // namespace selvage::cli
