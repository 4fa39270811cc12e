#include "cli/bench/bench_queries_command.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/query_bench.h"
#include "cli/answer/result.h"
#include "cli/arguments/number_check.h"
#include "cli/arguments/output_check.h"
#include "cli/bench/bench_figures.h"
#include "cli/bench/bench_outputs.h"
#include "cli/bench/plugin_method.h"
#include "cli/command.h"
#include "cli/process/terminal.h"

namespace selvage::cli {
namespace {

struct QueriesArguments {
  std::vector<std::string> files;
  std::string kind;
  PluginArguments plugin;
  BenchOutputs outputs;
  bench::QueryBenchOptions options;
};

PairKind kind_of(const std::string& file, const std::string& named) {
  if (named == "vf") return PairKind::kVf;
  if (named == "ee") return PairKind::kEe;
  if (const auto kind = bench::kind_of_path(file)) return *kind;
  throw UsageError(file + ": vertex-face or edge-edge queries? No name says it: " +
                   "FILE_vf.csv, FILE_ee.csv, or a folder vertex-face or edge-edge; use --kind");
}

std::string table(const bench::QueryBenchReport& report) {
  std::string text =
      fmt::format("{} queries, {} with a contact; truth from the files for {}, from the exact checker for {}\n",
                  report.queries, report.positives, report.truth_in_files, report.queries - report.truth_in_files);
  const std::string guest = report.guest ? fmt::format("{} {}", bench::kGuestRow, report.guest->name) : "";
  const std::size_t width = std::max<std::size_t>(9, guest.size());
  text += fmt::format("{:<{}} {:>7} {:>7} {:>10} {:>8} {:>10} {:>9} {:>10} {:>11}  {}\n", "method", width, "missed",
                      "false", "unresolved", "late toi", "mean ns", "median ns", "p99 ns", "max ns",
                      "toi early: median, p99, max");
  for (const bench::MethodReport& method : report.methods) {
    const std::string late = method.gives_toi ? std::to_string(method.toi.late) : "-";
    text += fmt::format("{:<{}} {:>7} {:>7} {:>10} {:>8} {:>10.0f} {:>9.0f} {:>10.0f} {:>11.0f}",
                        method.name == bench::kGuestRow ? guest : method.name, width, method.false_negatives,
                        method.false_positives, method.unresolved, late, method.ns.mean, method.ns.median,
                        method.ns.p99, method.ns.max);
    if (method.gives_toi) {
      text +=
          fmt::format("  {:.1e}, {:.1e}, {:.1e}", method.toi.early_median, method.toi.early_p99, method.toi.early_max);
    }
    text += '\n';
  }
  if (report.guest) {
    text += fmt::format("{}; {} of its false alarms beyond that\n", words_of(*report.guest),
                        report.methods.back().false_positives_beyond_gap.value());
  }
  return text + fmt::format(
                    "one thread; mean: processor time of the best whole pass; the others: wall time of single queries, "
                    "best of the "
                    "passes, {:.0f} ns of clock included\n",
                    report.clock_ns);
}

/// A truth that is wrong makes misses and false alarms of right answers.
void print_contradicted(const std::vector<std::string>& places) {
  constexpr std::size_t kMax = 10;
  for (const std::string& place : std::span(places).first(std::min(kMax, places.size()))) {
    say("selvage: {}: the truth is contradicted by the exact checker; correct the seventh column\n", place);
  }
  if (places.size() > kMax) say("selvage: ... and {} more\n", places.size() - kMax);
}

ExitCode bench_queries(const QueriesArguments& arguments) {
  std::vector<std::filesystem::path> inputs = {arguments.files.begin(), arguments.files.end()};
  if (!arguments.plugin.library.empty()) inputs.emplace_back(arguments.plugin.library);
  require_outputs(inputs, arguments.outputs.files());
  std::vector<bench::QueryFile> files;
  std::size_t count = 0;
  for (const std::string& name : arguments.files) {
    files.push_back({name, kind_of(name, arguments.kind), io::read_query_csv(name)});
    count += files.back().queries.size();
  }
  if (count == 0) throw io::Error(io::ErrorKind::kBadInput, arguments.files.front() + ": no queries to measure");
  std::optional<bench::GuestMethod<bench::QueryTimes>> guest;
  if (!arguments.plugin.library.empty()) {  // before there are threads, and before the others have taken their time
    auto measured = measure_plugin(arguments.plugin, files, arguments.options.repeat);
    if (!measured.misbehaviour.empty()) {
      say("selvage: {}\n", measured.misbehaviour);
      return ExitCode::kViolation;
    }
    guest = std::move(measured.method);
  }
  const bench::QueryBenchReport report = bench::run_query_bench(files, arguments.options, guest);
  print_result(table(report), arguments.outputs.files());
  if (!arguments.outputs.json.empty()) write_report(arguments.outputs.json, bench::to_json(report));
  if (!arguments.outputs.svg.empty()) write_report(arguments.outputs.svg, plot::to_svg(figure_of(report)));
  print_contradicted(report.contradicted);
  const auto must_be_safe = [](const bench::MethodReport& method) {
    return method.name == "kernel" || method.name == bench::kGuestRow;
  };
  const bool is_right = report.contradicted.empty() && std::ranges::none_of(report.methods, [&](const auto& method) {
                          return must_be_safe(method) && method.is_unsafe();
                        });
  return is_right ? ExitCode::kClean : ExitCode::kViolation;
}

}  // namespace

void add_bench_queries_command(CLI::App& bench, Job& job) {
  CLI::App& queries = add_command(
      bench, "queries",
      "The kernel, the textbook method and the exact checker on files of queries (CSV of the "
      "public sets), and with --plugin somebody's own kernel. Exit code 1 if the kernel or the plugin missed a contact "
      "or answered late, if the plugin misbehaves (then nothing is measured), or if the exact checker contradicts the "
      "truth of a file.",
      "selvage bench queries vertex-face/data_0_0.csv edge-edge/data_0_0.csv --json out.json");
  const auto arguments = std::make_shared<QueriesArguments>();
  queries.add_option("FILE", arguments->files, "CSV files: eight rows a query, three rationals a row, truth optional")
      ->required();
  queries.add_option("--kind", arguments->kind, "vf or ee, for files whose names do not say")
      ->check(CLI::IsMember({"vf", "ee"}));
  add_plugin(queries, arguments->plugin);
  add_outputs(queries, arguments->outputs);
  queries.add_option("--repeat", arguments->options.repeat, "Timed passes")
      ->check(whole_between(1, 10000))
      ->capture_default_str();
  queries.add_option("--tolerance", arguments->options.tolerance, "The kernel's tolerance at the end of the step")
      ->check(number_from(0))
      ->capture_default_str();
  queries.callback([arguments, &job] { job = [arguments] { return bench_queries(*arguments); }; });
}

}  // namespace selvage::cli
