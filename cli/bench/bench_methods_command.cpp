#include "cli/bench/bench_methods_command.h"

#include <algorithm>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "bench/method_bench.h"
#include "cli/answer/result.h"
#include "cli/arguments/number_check.h"
#include "cli/arguments/output_check.h"
#include "cli/bench/bench_figures.h"
#include "cli/bench/bench_outputs.h"
#include "cli/bench/hard_queries.h"
#include "cli/command.h"
#include "io/file/text.h"

namespace selvage::cli {
namespace {

struct MethodsArguments {
  std::string frame_t0, frame_t1;
  int sheet = 60, hard = 2000, most = 100'000;
  BenchOutputs outputs;
  bench::MethodBenchOptions options;
};

std::string table(const bench::SetReport& report) {
  std::string text = fmt::format("{} ({}): {} vf + {} ee, {} touch\n", report.name, report.what, report.vf, report.ee,
                                 report.touching);
  text += fmt::format("  {:<18} {:<14} {:>7} {:>12} {:>8} {:>6} {:>9} {:>9} {:>9} {:>9} {:>8}\n", "method", "setting",
                      "missed", "false alarms", "gave up", "late", "by", "early p50", "early p99", "ns", "ratio");
  for (const bench::SettingReport& row : report.settings) {
    text += fmt::format("  {:<18} {:<14} {:>7} {:>12} {:>8} {:>6} {:>9.1e} {:>9.1e} {:>9.1e} {:>9.0f} {:>8.2f}\n",
                        row.method, row.setting, row.misses, row.false_alarms, row.gave_up, row.toi.late,
                        row.toi.late_max, row.toi.early_median, row.toi.early_p99, row.ns, row.ratio);
  }
  return text;
}

ExitCode bench_methods(const MethodsArguments& arguments) {
  require_outputs({arguments.frame_t0, arguments.frame_t1}, arguments.outputs.files());
  std::vector<bench::SetReport> reports;
  const auto run = [&](const bench::QuerySet& set) {
    if (set.queries.empty()) {
      return print_result(fmt::format("{}: no candidate pairs, so nothing is asked\n", set.name),
                          arguments.outputs.files());
    }
    reports.push_back(bench::run_method_bench(set, arguments.options));
    print_result(table(reports.back()), arguments.outputs.files());
  };
  const auto most = static_cast<std::size_t>(arguments.most);
  if (!arguments.frame_t0.empty()) {
    if (arguments.frame_t1.empty()) throw UsageError("a motion needs two frames: add FRAME_T1");
    const bench::MeshMotion motion = bench::read_mesh_motion(arguments.frame_t0, arguments.frame_t1);
    const auto name_of = [](const std::filesystem::path& file) { return io::printable(file.filename().string()); };
    run(bench::candidate_set(name_of(arguments.frame_t0) + " to " + name_of(arguments.frame_t1), motion, most));
  }
  if (arguments.sheet > 0) {
    const bench::MeshMotion motion = bench::crumpled_sheet(arguments.sheet);
    run(bench::candidate_set("crumpled sheet", motion, most));
  }
  if (arguments.hard > 0) {
    for (const bench::QuerySet& set : hard_query_sets(arguments.hard)) run(set);
  }
  print_result(fmt::format("one thread; processor time of the best of up to {} passes; ratio: to {} {} in the same "
                           "run; the exact checker "
                           "says "
                           "the truth; times of impact as shares of the step\n",
                           arguments.options.repeat, bench::kBaselineMethod, bench::kBaselineSetting),
               arguments.outputs.files());
  if (!arguments.outputs.json.empty()) write_report(arguments.outputs.json, bench::to_json(reports));
  if (!arguments.outputs.svg.empty()) write_report(arguments.outputs.svg, plot::to_svg(figure_of(reports)));
  return std::any_of(reports.begin(), reports.end(), bench::breaks_promise) ? ExitCode::kViolation : ExitCode::kClean;
}

}  // namespace

void add_bench_methods_command(CLI::App& bench, Job& job) {
  CLI::App& methods = add_command(bench, "methods",
                                  "The textbook method, the kernel, additive and inclusion-based CCD and the exact "
                                  "checker, each at several settings: on the "
                                  "motion of a mesh between two files, on a crumpled sheet, and on the fuzzer's hard "
                                  "classes. Exit code 1 if a method missed "
                                  "a contact or was late that promises not to.",
                                  "selvage bench methods cloth_ball92.ply cloth_ball93.ply --json out.json");
  const auto arguments = std::make_shared<MethodsArguments>();
  methods.add_option("FRAME_T0", arguments->frame_t0, "Mesh at t = 0 (.obj, .ply)");
  methods.add_option("FRAME_T1", arguments->frame_t1, "The same mesh at t = 1");
  methods.add_option("--sheet", arguments->sheet, "Vertices along one side of the crumpled sheet; 0: without it")
      ->check(whole_between(0, 2000))
      ->capture_default_str();
  methods.add_option("--most", arguments->most, "Candidates of a mesh that are asked, about; spread over all")
      ->check(whole_between(1, 100'000'000))
      ->capture_default_str();
  methods.add_option("--hard", arguments->hard, "Queries of each group of hard classes, about; 0: without them")
      ->check(whole_between(0, 10'000'000))
      ->capture_default_str();
  methods.add_option("--repeat", arguments->options.repeat, "Timed passes")
      ->check(whole_between(1, 10000))
      ->capture_default_str();
  add_outputs(methods, arguments->outputs);
  methods.callback([arguments, &job] { job = [arguments] { return bench_methods(*arguments); }; });
}

}  // namespace selvage::cli
