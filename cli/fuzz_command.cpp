#include "cli/fuzz_command.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/interrupt.h"
#include "cli/terminal.h"
#include "fuzz/campaign.h"
#include "io/atomic_file.h"

namespace selvage::cli {
namespace {

using Clock = std::chrono::steady_clock;

struct Arguments {
  std::vector<std::string> properties;
  std::int64_t cases = 1000;
  std::string time;
  std::uint64_t seed = 1;
  std::string artifacts = "fuzz-artifacts";
};

/// Cases of each class in one round; a time limit ends a campaign between rounds, so that all classes get their share.
constexpr std::int64_t kRound = 500;
/// Kept cases a class and kind; all failures are counted.
constexpr std::int64_t kKeptPerClass = 5;

struct Row {
  const fuzz::QueryClass* query_class = nullptr;
  PairKind kind = PairKind::kVf;
  fuzz::Tally tally;
};

std::optional<std::chrono::duration<double>> parse_time(const std::string& text) {
  if (text.empty()) return std::nullopt;
  std::size_t used = 0;
  double amount = 0;
  try {
    amount = std::stod(text, &used);
  } catch (const std::logic_error&) {
    throw UsageError("--time wants seconds, minutes or hours, as in 60s, 10m, 2h");
  }
  const std::string unit = text.substr(used);
  const double scale = unit.empty() || unit == "s" ? 1 : unit == "m" ? 60 : unit == "h" ? 3600 : 0;
  if (!(amount > 0) || scale == 0) throw UsageError("--time wants seconds, minutes or hours, as in 60s, 10m, 2h");
  return std::chrono::duration<double>(amount * scale);
}

std::vector<const fuzz::QueryProperty*> chosen_properties(const std::vector<std::string>& names) {
  std::vector<const fuzz::QueryProperty*> chosen;
  for (const fuzz::QueryProperty& property : fuzz::query_properties()) {
    const bool named = std::find(names.begin(), names.end(), property.name) != names.end();
    if (named || names.empty()) chosen.push_back(&property);
  }
  return chosen;
}

std::string kept_name(const fuzz::Failure& failure, std::uint64_t seed) {
  return fmt::format("{}-{}-{}-{}-{}.case", failure.property, failure.query_class,
                     fuzz::name_of(failure.kept.query.kind), seed, failure.number);
}

/// One property over all classes, round by round. Writes each failure before anything else happens.
class Campaign {
 public:
  Campaign(const fuzz::QueryProperty& property, const Arguments& arguments)
      : property_(property), arguments_(arguments) {
    for (const fuzz::Chunk& chunk : fuzz::make_chunks(0, std::int64_t{1} << 40)) {
      rows_.push_back({chunk.query_class, chunk.kind, {}});
    }
  }

  /// Runs until `cases` a class or the deadline. False: interrupted.
  bool run(std::int64_t cases, const std::optional<Clock::time_point>& deadline) {
    ProgressBar bar(std::string(property_.name));
    for (std::int64_t first = 0; first < cases; first += kRound) {
      const std::vector<fuzz::Chunk> chunks = fuzz::make_chunks(first, std::min(kRound, cases - first));
      std::size_t done = 0;
      for (const fuzz::Chunk& chunk : chunks) {
        if (interrupted()) return false;
        row_of(chunk).tally += fuzz::run_chunk(property_, fuzz::selvage_kernel, arguments_.seed, chunk,
                                               [&](const fuzz::Failure& failure) { keep(failure, chunk); });
        bar.update(++done, chunks.size());
      }
      if (deadline && Clock::now() >= *deadline) break;
    }
    return true;
  }

  /// The table; returns whether everything held.
  bool report() const {
    const bool bands_apply = property_.name == "ccd";
    fmt::print("{}: {}\n", property_.name, property_.promise);
    fmt::print("  {:<33} {:<4} {:>9} {:>9} {:>9} {:>9} {:>10} {:>9} {:>8}\n", "class", "kind", "queries", "touches",
               "hits", "alarms", "unresolved", "undecided", "failures");
    fuzz::Tally total;
    bool held = true;
    for (const Row& row : rows_) {
      const fuzz::Tally& tally = row.tally;
      if (tally.cases == 0) continue;
      total += tally;
      const bool idle = fuzz::is_unresolved_too_often(row.kind, tally);
      const bool dead = bands_apply && fuzz::is_out_of_band(*row.query_class, row.kind, tally);
      fmt::print("  {:<33} {:<4} {:>9} {:>9} {:>9} {:>9} {:>10} {:>9} {:>8}{}\n", row.query_class->name,
                 fuzz::name_of(row.kind), tally.cases, tally.touches, tally.hits, tally.alarms, tally.unresolved,
                 tally.undecided, tally.failures,
                 dead   ? "  hits outside the declared band"
                 : idle ? "  unresolved too often"
                        : "");
      held = held && !dead && !idle;
    }
    fmt::print("  {:<33} {:<4} {:>9} {:>9} {:>9} {:>9} {:>10} {:>9} {:>8}\n", "all", "", total.cases, total.touches,
               total.hits, total.alarms, total.unresolved, total.undecided, total.failures);
    return held && total.failures == 0;
  }

 private:
  Row& row_of(const fuzz::Chunk& chunk) {
    const auto same = [&](const Row& row) { return row.query_class == chunk.query_class && row.kind == chunk.kind; };
    return *std::find_if(rows_.begin(), rows_.end(), same);
  }

  void keep(const fuzz::Failure& failure, const fuzz::Chunk& chunk) {
    if (++kept_[{chunk.query_class, chunk.kind}] > kKeptPerClass) return;
    const std::filesystem::path folder = arguments_.artifacts;
    std::filesystem::create_directories(folder);
    const std::filesystem::path file = folder / kept_name(failure, arguments_.seed);
    io::write_atomically(file, fuzz::format_case(failure.kept));
    fmt::print(stderr, "{}: {} {}, kept as {}\n", failure.property, failure.query_class, failure.what, file.string());
  }

  const fuzz::QueryProperty& property_;
  const Arguments& arguments_;
  std::vector<Row> rows_;
  std::map<std::pair<const fuzz::QueryClass*, PairKind>, std::int64_t> kept_;
};

ExitCode fuzz_queries(const Arguments& arguments) {
  const auto limit = parse_time(arguments.time);
  const auto properties = chosen_properties(arguments.properties);
  bool held = true;
  for (const fuzz::QueryProperty* property : properties) {
    std::optional<Clock::time_point> deadline;
    std::int64_t cases = arguments.cases;
    if (limit) {
      const auto share = std::chrono::duration_cast<Clock::duration>(*limit / static_cast<double>(properties.size()));
      deadline = Clock::now() + share;
      cases = std::int64_t{1} << 40;  // until then
    }
    Campaign campaign(*property, arguments);
    const bool finished = campaign.run(cases, deadline);
    held = campaign.report() && held;
    if (!finished) return held ? ExitCode::kInterrupted : ExitCode::kViolation;
  }
  return held ? ExitCode::kClean : ExitCode::kViolation;
}

}  // namespace

void add_fuzz_command(CLI::App& program, Job& job) {
  CLI::App& fuzz =
      add_command(program, "fuzz",
                  "Attacks the kernel with constructed queries and judges its answers by exact arithmetic. "
                  "Exit code 1 if a promise broke or a class of queries has gone dead; failures are kept.",
                  "selvage fuzz ccd --time 60s --seed 7");
  const auto arguments = std::make_shared<Arguments>();
  std::vector<std::string> names;
  for (const fuzz::QueryProperty& property : fuzz::query_properties()) names.emplace_back(property.name);
  fuzz.add_option("PROPERTY", arguments->properties,
                  "Which promises to attack: " + fmt::format("{}", fmt::join(names, ", ")) + "; all if none is named")
      ->check(CLI::IsMember(names));
  auto* cases = fuzz.add_option("--cases", arguments->cases, "Queries of each class and kind, for each property")
                    ->check(CLI::PositiveNumber)
                    ->capture_default_str();
  fuzz.add_option("--time", arguments->time, "Instead of --cases: run this long in all, as in 60s, 10m, 2h")
      ->excludes(cases);
  fuzz.add_option("--seed", arguments->seed, "Cases depend on it alone")->capture_default_str();
  fuzz.add_option("--artifacts", arguments->artifacts, "Folder for kept failures; made when the first one is found")
      ->capture_default_str();
  fuzz.callback([arguments, &job] { job = [arguments] { return fuzz_queries(*arguments); }; });
}

}  // namespace selvage::cli
