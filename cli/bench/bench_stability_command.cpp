#include "cli/bench/bench_stability_command.h"

#include <algorithm>
#include <memory>

#include <fmt/format.h>

#include "bench/stability/suite.h"
#include "cli/answer/result.h"
#include "cli/arguments/output_check.h"
#include "cli/command.h"
#include "cli/process/interrupt.h"
#include "cli/process/terminal.h"

namespace selvage::cli {
namespace {

struct StabilityArguments {
  std::vector<std::string> names;
  std::string json;
  bool list = false, quick = false;
};

std::vector<bench::StabilityCase> chosen_cases(const std::vector<std::string>& names) {
  std::vector<bench::StabilityCase> all = bench::stability_cases();
  if (names.empty()) return all;
  std::vector<bench::StabilityCase> chosen;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(all, name, &bench::StabilityCase::name);
    if (found == all.end()) throw UsageError(fmt::format("no case \"{}\"; --list names them all", name));
    chosen.push_back(*found);
  }
  return chosen;
}

ExitCode bench_stability(const StabilityArguments& arguments) {
  const std::vector<bench::StabilityCase> cases = chosen_cases(arguments.names);
  if (arguments.list) {
    for (const bench::StabilityCase& c : cases)
      fmt::print("{:<22} {}\n{:<22} asked: {}\n", c.name, c.difficulty, "", c.criterion);
    return ExitCode::kClean;
  }
  require_outputs({}, {arguments.json});
  catch_interrupts();
  ProgressBar bar("hard cases");
  bench::StabilityOptions options;
  options.quick = arguments.quick;
  options.progress = [&bar](std::size_t done, std::size_t total) {
    bar.update(done, total);
    return !interrupted();
  };
  const auto finished = bench::run_stability(cases, options);
  if (!finished) {
    say("selvage: interrupted; nothing was written\n");
    return ExitCode::kInterrupted;
  }
  const std::vector<bench::StabilityCaseReport>& reports = *finished;
  print_result(bench::to_markdown(reports), {arguments.json});
  if (!arguments.json.empty()) write_report(arguments.json, bench::to_json(reports, arguments.quick));
  const auto failed = std::ranges::count_if(reports, [](const auto& report) { return !report.passed(); });
  print_result(fmt::format("\n{} cases, {} failed\n", reports.size(), failed), {arguments.json});
  return failed == 0 ? ExitCode::kClean : ExitCode::kViolation;
}

}  // namespace

void add_bench_stability_command(CLI::App& bench, Job& job) {
  CLI::App& stability =
      add_command(bench, "stability",
                  "Named hard cases for the collision step and the simulator, each at three resolutions, at the origin "
                  "and a million lengths from it; every step is checked exactly. Exit code 1 if any fails.",
                  "selvage bench stability --case knot --json out.json");
  const auto arguments = std::make_shared<StabilityArguments>();
  stability.add_option("--case", arguments->names, "Only this case; may be repeated");
  stability.add_flag("--list", arguments->list, "Print the cases and what is asked of each, and run nothing");
  stability.add_flag("--quick", arguments->quick, "The coarse resolution alone, and few steps");
  stability.add_option("--json", arguments->json, "Also write the report to this file");
  stability.callback([arguments, &job] { job = [arguments] { return bench_stability(*arguments); }; });
}

}  // namespace selvage::cli
