#include "cli/verify_command.h"

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <tbb/global_control.h>

#include "cli/command.h"
#include "cli/interrupt.h"
#include "cli/sequence_argument.h"
#include "cli/terminal.h"
#include "cli/verdict.h"
#include "io/atomic_file.h"
#include "io/sequence.h"
#include "verify/check.h"
#include "verify/report.h"

namespace selvage::cli {
namespace {

struct Arguments {
  SequenceArgument sequence;
  bool frames_only = false, motion = false, bodies = false;
  std::optional<double> min_distance;
  std::string json;
  std::optional<std::int64_t> max_violations;
  std::int64_t threads = 0;
};

/// Where the user names no number: what a reader of the JSON can page through, and what fits on a terminal.
constexpr std::int64_t kViolationsInJson = 100;
constexpr std::int64_t kViolationsInText = 10;

void check(const Arguments& arguments) {
  if (arguments.min_distance && !(*arguments.min_distance >= 0 && std::isfinite(*arguments.min_distance))) {
    throw UsageError("--min-distance must be finite and not negative");
  }
}

verify::SequenceReport check_sequence(const io::SequenceReader& sequence, const Arguments& arguments) {
  verify::SequenceOptions options;
  options.check.max_violations = static_cast<std::size_t>(arguments.max_violations.value_or(kViolationsInJson));
  options.check.min_distance = arguments.min_distance;
  options.check.check_bodies = arguments.bodies;
  options.motions = arguments.motion || (!arguments.frames_only && sequence.kind() == io::SequenceKind::kSteps);
  ProgressBar bar("verify");
  options.progress = [&](std::size_t done, std::size_t total) {
    bar.update(done, total);
    return !interrupted();
  };
  return verify::check_sequence(sequence, options);
}

ExitCode run(const Arguments& arguments) {
  check(arguments);
  std::optional<tbb::global_control> threads;
  if (arguments.threads > 0) {
    threads.emplace(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(arguments.threads));
  }
  const auto sequence = open_sequence(arguments.sequence);
  if (arguments.motion && sequence->frame_count() == 1) {
    throw UsageError("--motion needs at least two frames, and there is one: no motion would be checked");
  }
  const verify::SequenceReport report = check_sequence(*sequence, arguments);
  verify::ReportContext context{std::string("selvage ") + SELVAGE_VERSION, {}, {}};
  for (const std::filesystem::path& source : arguments.sequence.sources) context.sources.push_back(source.string());
  for (std::size_t i = 0; i < sequence->frame_count(); ++i) context.frame_names.push_back(sequence->frame_name(i));
  if (!arguments.json.empty()) io::write_atomically(arguments.json, verify::json_report(report, context));
  const auto max_listed = static_cast<std::size_t>(arguments.max_violations.value_or(kViolationsInText));
  print_report(verify::text_report(report, context, max_listed), report.verdict);
  return exit_code(report.verdict);
}

}  // namespace

void add_verify_command(CLI::App& program, Job& job) {
  CLI::App& command =
      add_command(program, "verify", "Check a mesh sequence exactly: frames, and the motion between them",
                  "selvage verify run/ --json report.json");
  const auto arguments = std::make_shared<Arguments>();
  add_sequence_argument(command, arguments->sequence);
  CLI::Option* frames_only = command.add_flag("--frames-only", arguments->frames_only, "Check frames, never motions");
  command
      .add_flag("--motion", arguments->motion,
                "Check the straight motion between frames too (default only where the sequence says it holds steps)")
      ->excludes(frames_only);
  command
      .add_option("--min-distance", arguments->min_distance,
                  "Frames: features without a common vertex must be at least this far apart")
      ->type_name("LENGTH");
  command.add_option("--json", arguments->json, "Write the report as JSON")->type_name("FILE");
  command
      .add_option("--max-violations", arguments->max_violations,
                  fmt::format("List at most this many; all are counted (default: {} in the JSON, {} on the terminal)",
                              kViolationsInJson, kViolationsInText))
      ->check(CLI::NonNegativeNumber);  // as a signed number: an unsigned one would wrap "-3" around
  command.add_option("--threads", arguments->threads, "Number of threads; 0: one a core")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command.add_flag("--bodies", arguments->bodies, "Check bodies against each other and themselves too");
  command.callback([arguments, &job] { job = [arguments] { return run(*arguments); }; });
}

}  // namespace selvage::cli
