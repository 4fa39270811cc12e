#include "cli/fuzz_command.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <oneapi/tbb/global_control.h>

#include "cli/answer/fuzz_table.h"
#include "cli/answer/replay.h"
#include "cli/arguments/number_check.h"
#include "cli/arguments/output_check.h"
#include "cli/arguments/shard.h"
#include "cli/command.h"
#include "cli/page/conformance_page.h"
#include "cli/process/interrupt.h"
#include "cli/process/terminal.h"
#include "fuzz/plugin/conformance.h"
#include "fuzz/run/campaign_stats.h"
#include "fuzz/run/driver.h"
#include "io/file/atomic_file.h"
#include "io/file/text.h"
#include "kernel/version.h"

namespace selvage::cli {
namespace {

struct FuzzArguments {
  std::vector<std::string> properties;
  std::int64_t cases = 0;
  std::string time;
  std::uint64_t seed = 1;
  int jobs = 0;
  std::string artifacts = "fuzz-artifacts", shard = "1/1", only, plugin;
  double case_time_s = fuzz::kCaseSeconds;
  bool resume = false, list = false;
};

[[noreturn]] void refuse_time() {
  throw UsageError("--time wants seconds, minutes, hours or days, as in 60s, 10m, 2h, 7d");
}

double parse_seconds(std::string_view text) {
  double scale = 1;
  for (const auto& [unit, seconds] :
       {std::pair('s', 1.0), std::pair('m', 60.0), std::pair('h', 3600.0), std::pair('d', 86400.0)}) {
    if (!text.ends_with(unit)) continue;
    scale = seconds;
    text.remove_suffix(1);
    break;
  }
  double amount = 0;
  const bool is_number = io::parse_number(text, amount) == io::NumberFault::kNone;
  if (!is_number || !(amount > 0) || !std::isfinite(amount * scale)) refuse_time();
  return amount * scale;
}

fuzz::Properties chosen_properties(const std::vector<std::string>& names) {
  fuzz::Properties all = fuzz::all_properties(), chosen;
  for (const std::string& name : names) {
    const auto known = [&](const auto& property) { return property && property->name() == name; };
    if (std::ranges::none_of(all, known)) throw UsageError("there is no property '" + name + "'; see --list");
  }
  for (auto& property : all) {
    if (names.empty() || std::ranges::find(names, property->name()) != names.end())
      chosen.push_back(std::move(property));
  }
  return chosen;
}

std::optional<std::int64_t> parse_case_number(std::string_view text) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_whole = error == std::errc() && end == text.data() + text.size();
  return is_whole && number >= 0 ? std::optional(number) : std::nullopt;
}

/// What `selvage replay` says of a case that has just run: of a query whatever it came to, of others where they fail.
std::string explanation(fuzz::Property& property, const fuzz::Stream& stream, std::int64_t number,
                        const FuzzArguments& arguments, const std::string& failure) {
  // What is made on the way may start threads, which the process of a plugin could not take along.
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const fuzz::ChoiceSource source = fuzz::ChoiceSource::from_seed(fuzz::case_seed(arguments.seed, stream, number));
  const std::string origin = fuzz::case_origin(property, stream, arguments.seed, number);
  const bool is_query = stream.group != 0;
  if (failure.empty() && !is_query) return {};
  std::optional<PluginToAsk> asked;
  if (!arguments.plugin.empty()) asked = {arguments.plugin, arguments.case_time_s};
  return replay_text(property.kept(stream, source, origin, failure, false), arguments.only, asked).text;
}

/// "STREAM:NUMBER" of the only property.
ExitCode run_only(const FuzzArguments& arguments, fuzz::Properties& properties) {
  const std::size_t colon = arguments.only.rfind(':');
  std::string name = arguments.only.substr(0, colon);
  std::ranges::replace(name, '/', ' ');
  if (properties.size() != 1 || colon == std::string::npos) {
    throw UsageError("--only wants one property, and STREAM:NUMBER as the table prints it");
  }
  const std::optional<std::int64_t> number = parse_case_number(std::string_view(arguments.only).substr(colon + 1));
  if (!number) throw UsageError("--only wants STREAM:NUMBER, a number from 0 up; not '" + arguments.only + "'");
  fuzz::Property& property = *properties.front();
  const auto stream = std::ranges::find(property.streams(), name, &fuzz::Stream::name);
  if (stream == property.streams().end())
    throw UsageError("--only: " + property.name() + " has no stream '" + name + "'");
  const fuzz::OneCase one = fuzz::run_case(property, *stream, arguments.seed, *number, arguments.case_time_s);
  const std::string& failure = one.outcome.failure;
  fmt::print("promise tested by {}: {}\n  {}: {}, case {} of seed {}\n", property.name(), property.promise(),
             stream->name, failure.empty() ? "holds" : failure, *number, arguments.seed);
  fmt::print(" ");
  for (std::size_t i = 0; i < property.counters().size(); ++i) {
    fmt::print(" {}: {}{}", property.counters()[i], one.outcome.counts.of[i],
               i + 1 < property.counters().size() ? "," : "\n");
  }
  // Where Selvage's own code has killed a process, this one does not run it again.
  if (!one.has_died || !arguments.plugin.empty()) {
    fmt::print("{}", explanation(property, *stream, *number, arguments, failure));
  }
  return failure.empty() ? ExitCode::kClean : ExitCode::kViolation;
}

/// One line that overwrites itself, where a person watches.
class StatusLine {
 public:
  explicit StatusLine(const fuzz::Driver& driver) : driver_(driver), enabled_(is_terminal(2)) {}
  ~StatusLine() {
    if (enabled_) say("\r\033[K");
  }
  StatusLine(const StatusLine&) = delete;
  StatusLine& operator=(const StatusLine&) = delete;

  void update(const fuzz::DriverStatus& status) const {
    if (!enabled_) return;
    constexpr const char* kCutOff = "\033[?7l";  // at the terminal's edge: a line that wrapped could not be overwritten
    constexpr const char* kWrap = "\033[?7h";
    say("\r\033[K{}{}{}", kCutOff, fuzz::status_line(driver_.ledger(), status), kWrap);
  }

 private:
  const fuzz::Driver& driver_;
  bool enabled_;
};

/// Whether it came to its end. The line is gone by then: what is printed next stands in its place.
bool run_watched(fuzz::Driver& driver) {
  catch_interrupts();
  const StatusLine line(driver);
  return driver.run(interrupted, [&](const fuzz::DriverStatus& status) { line.update(status); });
}

fuzz::DriverOptions driver_options(const FuzzArguments& arguments) {
  fuzz::DriverOptions options;
  options.cases = arguments.cases;
  if (!arguments.time.empty()) options.seconds = parse_seconds(arguments.time);
  if (arguments.time.empty() && arguments.cases == 0) options.seconds = 60;
  options.seed = arguments.seed;
  options.jobs =
      arguments.jobs > 0 ? arguments.jobs : static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  options.folder = arguments.artifacts;
  const Shard shard = parse_shard(arguments.shard);
  if (shard.count > fuzz::kMaxShards) {
    throw UsageError(fmt::format("--shard {}: a campaign has at most {} shards", arguments.shard, fuzz::kMaxShards));
  }
  options.shard = static_cast<std::int64_t>(shard.index);
  options.shards = static_cast<std::int64_t>(shard.count);
  options.resume = arguments.resume;
  options.case_seconds = arguments.case_time_s;
  options.version = SELVAGE_VERSION;
  return options;
}

/// A campaign that was stopped has work left, whatever it has found: whoever reads 1 as an answer would not go on.
ExitCode exit_code_of(bool finished, bool held, bool is_whole) {
  if (!finished) return ExitCode::kInterrupted;
  if (!held) return ExitCode::kViolation;
  return is_whole ? ExitCode::kClean : ExitCode::kLimit;
}

/// Someone else's code under the query level.
ExitCode run_plugin(const FuzzArguments& arguments) {
  if (!arguments.properties.empty()) throw UsageError("--plugin runs the conformance test and nothing else");
  const std::filesystem::path folder = arguments.artifacts;
  const std::filesystem::path json = folder / "conformance.json", plain = folder / "conformance.txt",
                              html = folder / "conformance.html";
  require_separate_outputs({arguments.plugin}, {json, plain, html});
  const std::uint32_t crc32 = fuzz::crc32_of_plugin(arguments.plugin);
  const fuzz::PluginInfo info = fuzz::probe_plugin(arguments.plugin, arguments.case_time_s);
  fuzz::Properties properties;
  properties.push_back(fuzz::make_conformance(arguments.plugin, crc32, info.gap));
  if (!arguments.only.empty()) return run_only(arguments, properties);
  fuzz::DriverOptions options = driver_options(arguments);
  options.target = std::string("plugin ") + info.name;
  options.plugin_crc32 = crc32;
  fuzz::Driver driver(properties, options);
  const bool finished = run_watched(driver);
  const fuzz::Ledger& ledger = driver.ledger();
  const ConformanceRun page{"selvage " SELVAGE_VERSION, arguments.plugin, arguments.artifacts, finished};
  const std::string text = fuzz::conformance_text(ledger, info, arguments.artifacts);
  io::write_atomically(json, fuzz::conformance_json(ledger, info));
  io::write_atomically(plain, text);
  io::write_atomically(html, conformance_page(ledger, *properties.front(), info, page));
  fmt::print("{}", text);
  const fuzz::PropertyLedger& done = ledger.properties.front();
  return exit_code_of(finished, done.findings.empty(), done.streams_without_cases() == 0);
}

ExitCode run(const FuzzArguments& arguments) {
  if (!arguments.plugin.empty()) return run_plugin(arguments);
  fuzz::Properties properties = chosen_properties(arguments.properties);
  if (arguments.list) {
    fmt::print("{}", fuzz_list(properties));
    return ExitCode::kClean;
  }
  if (!arguments.only.empty()) return run_only(arguments, properties);
  fuzz::Driver driver(properties, driver_options(arguments));
  const bool finished = run_watched(driver);
  const FuzzTable table = fuzz_table(driver.ledger(), properties, arguments.artifacts);
  const fuzz::DriverStatus& status = driver.status();
  fmt::print("{}{} cases in {:.1f} s, {:.1f} s of processor time: {:.0f} a second\n", table.text, status.cases,
             status.seconds, status.processor_seconds,
             static_cast<double>(status.cases) / std::max(status.seconds, 1e-3));
  return exit_code_of(finished, table.held, table.is_whole);
}

}  // namespace

void add_fuzz_command(CLI::App& program, Job& job) {
  CLI::App& fuzz =
      add_command(program, "fuzz",
                  "Attacks what Selvage promises with constructed cases, judged by exact arithmetic, in "
                  "worker processes. Exit code 1 if a promise broke or a class of cases has gone dead, 5 if "
                  "there was no time for a class; failures are shrunk and kept. docs/fuzzing.md says more",
                  "selvage fuzz ccd --time 60s --seed 7");
  const auto arguments = std::make_shared<FuzzArguments>();
  fuzz.add_option("PROPERTY", arguments->properties,
                  "Which promises to attack, as --list names them; all if none is named");
  auto* cases = fuzz.add_option("--cases", arguments->cases, "Cases of each property, rounded up to whole work units")
                    ->check(number_between(1, fuzz::kMaxCases));
  fuzz.add_option("--time", arguments->time, "Or run this long in all, as in 60s (the default), 10m, 2h, 7d")
      ->excludes(cases);
  fuzz.add_option("--seed", arguments->seed, "Cases depend on it alone")->check(whole_number())->capture_default_str();
  fuzz.add_option("--jobs", arguments->jobs, "Worker processes; as many as there are processors if not given")
      ->check(number_from(1));
  fuzz.add_option("--artifacts", arguments->artifacts, "Folder for campaign.json, stats.jsonl and kept cases")
      ->capture_default_str();
  fuzz.add_flag("--resume", arguments->resume, "Continue the campaign in that folder, where there is one");
  fuzz.add_option("--shard", arguments->shard, "A part of the campaign, i/N or auto (Slurm); selvage merge joins them")
      ->capture_default_str();
  fuzz.add_option("--case-time", arguments->case_time_s,
                  "Seconds that a case, or loading the plugin, may compute and sleep in all before it is a hang")
      ->check(number_above(0))
      ->capture_default_str();
  fuzz.add_option("--only", arguments->only, "Run one case again, STREAM:NUMBER as the table prints it");
  fuzz.add_option("--plugin", arguments->plugin,
                  "Test someone else's collision code instead: a library with the interface fuzz/selvage-plugin.h")
      ->type_name("LIB.so");
  fuzz.add_flag("--list", arguments->list, "Say what each property promises, and end");
  fuzz.callback([arguments, &job] { job = [arguments] { return run(*arguments); }; });
}

}  // namespace selvage::cli
