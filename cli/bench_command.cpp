#include "cli/bench_command.h"

#include <memory>
#include <vector>

#include <fmt/format.h>

#include "bench/query_bench.h"
#include "cli/command.h"
#include "io/atomic_file.h"

namespace selvage::cli {
namespace {

struct Arguments {
  std::vector<std::string> files;
  std::string kind, json;
  bench::QueryBenchOptions options;
};

PairKind kind_of(const std::string& file, const std::string& named) {
  if (named == "vf") return PairKind::kVf;
  if (named == "ee") return PairKind::kEe;
  if (const auto kind = bench::kind_of_path(file)) return *kind;
  throw UsageError(file + ": vertex-face or edge-edge queries? The name does not say; use --kind");
}

std::string table(const bench::QueryBenchReport& report) {
  std::string text =
      fmt::format("{} queries, {} with a contact; truth from the files for {}, from the exact checker for {}\n",
                  report.queries, report.positives, report.truth_in_files, report.queries - report.truth_in_files);
  text +=
      fmt::format("{:<9} {:>7} {:>7} {:>10} {:>8} {:>10} {:>9} {:>10} {:>11}  {}\n", "method", "missed", "false",
                  "unresolved", "late toi", "mean ns", "median ns", "p99 ns", "max ns", "toi early: median, p99, max");
  for (const bench::MethodReport& method : report.methods) {
    text += fmt::format("{:<9} {:>7} {:>7} {:>10} {:>8} {:>10.0f} {:>9.0f} {:>10.0f} {:>11.0f}", method.name,
                        method.false_negatives, method.false_positives, method.unresolved, method.toi.late,
                        method.ns.mean, method.ns.median, method.ns.p99, method.ns.max);
    if (method.name != "exact") {
      text +=
          fmt::format("  {:.1e}, {:.1e}, {:.1e}", method.toi.early_median, method.toi.early_p99, method.toi.early_max);
    }
    text += '\n';
  }
  return text + fmt::format(
                    "one thread; mean: processor time of the best whole pass; the others: wall time of single queries, "
                    "best of the "
                    "passes, {:.0f} ns of clock included\n",
                    report.clock_ns);
}

ExitCode bench_queries(const Arguments& arguments) {
  std::vector<bench::QueryFile> files;
  std::size_t count = 0;
  for (const std::string& name : arguments.files) {
    files.push_back({name, kind_of(name, arguments.kind), io::read_query_csv(name)});
    count += files.back().queries.size();
  }
  if (count == 0) throw io::Error(io::ErrorKind::kBadInput, arguments.files.front() + ": no queries to measure");
  const bench::QueryBenchReport report = bench::run_query_bench(files, arguments.options);
  fmt::print("{}", table(report));
  if (!arguments.json.empty()) io::write_atomically(arguments.json, bench::to_json(report));
  const bench::MethodReport& kernel = report.methods.front();
  return kernel.false_negatives == 0 && kernel.toi.late == 0 ? ExitCode::kClean : ExitCode::kViolation;
}

}  // namespace

void add_bench_command(CLI::App& program, Job& job) {
  CLI::App& bench = add_command(program, "bench", "Speed against error", "selvage bench queries data_vf.csv");
  bench.require_subcommand(1);
  CLI::App& queries =
      add_command(bench, "queries",
                  "The kernel, the textbook method and the exact checker on files of queries (CSV of the "
                  "public sets). Exit code 1 if the kernel missed a contact or answered late.",
                  "selvage bench queries vertex-face/data_0_0.csv edge-edge/data_0_0.csv --json out.json");
  const auto arguments = std::make_shared<Arguments>();
  queries.add_option("FILE", arguments->files, "CSV files: eight rows a query, three rationals a row, truth optional")
      ->required();
  queries.add_option("--kind", arguments->kind, "vf or ee, for files whose names do not say")
      ->check(CLI::IsMember({"vf", "ee"}));
  queries.add_option("--json", arguments->json, "Also write the report to this file");
  queries.add_option("--repeat", arguments->options.repeat, "Timed passes")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  queries.add_option("--tolerance", arguments->options.tolerance, "The kernel's tolerance at the end of the step")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  queries.callback([arguments, &job] { job = [arguments] { return bench_queries(*arguments); }; });
}

}  // namespace selvage::cli
