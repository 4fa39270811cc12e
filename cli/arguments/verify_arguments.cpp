#include "cli/arguments/verify_arguments.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "cli/arguments/named_bodies.h"
#include "cli/arguments/number_check.h"
#include "cli/arguments/shard.h"
#include "cli/process/exit_code.h"

namespace selvage::cli {
namespace {

/// "NAME=BEGIN:END"; a name may hold '='.
io::Group parse_group(const std::string& text) {
  const std::size_t equals = text.rfind('='), colon = text.rfind(':');
  io::Group group;
  bool is_good = equals != text.npos && equals > 0 && colon != text.npos && colon > equals;
  if (is_good) {
    const auto number = [&](std::size_t begin, std::size_t end, std::int32_t& value) {
      const auto [stop, error] = std::from_chars(text.data() + begin, text.data() + end, value);
      return error == std::errc() && stop == text.data() + end;
    };
    is_good = number(equals + 1, colon, group.face_begin) && number(colon + 1, text.size(), group.face_end);
  }
  if (!is_good) throw UsageError("--group wants NAME=BEGIN:END, a half-open range of faces; not '" + text + "'");
  group.name = text.substr(0, equals);
  return group;
}

std::vector<io::Group> parse_groups(const std::vector<std::string>& texts) {
  std::vector<io::Group> groups;
  for (const std::string& text : texts) groups.push_back(parse_group(text));
  return groups;
}

/// "A,B"; behind a backslash a comma or a backslash is part of a name.
std::array<std::string, 2> parse_exemption(const std::string& text) {
  std::vector<std::string> names(1);
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_escaped = text[i] == '\\' && i + 1 < text.size() && (text[i + 1] == ',' || text[i + 1] == '\\');
    if (text[i] == ',') {
      names.emplace_back();
    } else {
      names.back() += is_escaped ? text[++i] : text[i];
    }
  }
  if (names.size() != 2 || names[0].empty() || names[1].empty()) {
    throw UsageError("--exempt wants two groups, A,B (A,A for pairs within A; \\, for a comma in a name); not '" +
                     text + "'");
  }
  return {names[0], names[1]};
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::string yes_or_no(bool value) { return value ? "yes" : "no"; }

CLI::Option* add_repeatable(CLI::App& command, const char* name, std::vector<std::string>& values, const char* help) {
  return command.add_option(name, values, help)->allow_extra_args(false);
}

void add_what_may_touch(CLI::App& command, VerifyArguments& arguments) {
  add_repeatable(command, "--group", arguments.groups,
                 "A group of faces by their numbers, half-open; joined with the sequence's group of that name, if "
                 "there is one; may be repeated")
      ->type_name("NAME=BEGIN:END");
  add_repeatable(command, "--body", arguments.body,
                 "A is a body, where the format cannot say so: not checked against bodies and itself, unless --bodies; "
                 "may be repeated")
      ->type_name("A");
  add_repeatable(command, "--exempt", arguments.exempt,
                 "Faces of A and B may touch (sewn together); A,A: within A; \\, is a comma in a name. Counted in the "
                 "report; may be repeated")
      ->type_name("A,B");
  add_repeatable(command, "--ignore", arguments.ignore, "A is no part of the check; may be repeated")->type_name("A");
  command.add_flag(
      "--weld", arguments.weld,
      "Join vertices that lie at one place in every frame: equal numbers, -0 and 0 too (split at seams by the writer)");
}

void add_long_runs(CLI::App& command, VerifyArguments& arguments) {
  command
      .add_option("--shard", arguments.shard,
                  "Check part i of N of the frames, or auto: as the Slurm array job says; join with selvage merge")
      ->type_name("i/N");
  command.add_flag("--fail-fast", arguments.fail_fast,
                   "Stop behind the first frame that is violated, itself or in the motion that leads to it");
  command.add_flag("--resume", arguments.resume,
                   "Continue the run that was stopped before it finished the report of --json; start anew if there is "
                   "none");
}

}  // namespace

void add_verify_arguments(CLI::App& command, VerifyArguments& arguments) {
  add_sequence_argument(command, arguments.sequence);
  CLI::Option* frames_only = command.add_flag("--frames-only", arguments.frames_only, "Check frames, never motions");
  command
      .add_flag("--motion", arguments.motion,
                "Check the straight motion between frames too (default only where the sequence says it holds steps)")
      ->excludes(frames_only);
  command
      .add_option("--min-distance", arguments.min_distance,
                  "Frames: features without a common vertex must be at least this far apart")
      ->type_name("LENGTH")
      ->check(number_from(0));
  CLI::Option* second =
      command.add_flag("--second-opinion", arguments.second_opinion,
                       "Decide every pair that needed exact arithmetic, and every one that touches, again with CGAL; a "
                       "disagreement is exit code 7");
  command
      .add_flag("--second-opinion-all", arguments.second_opinion_all,
                "The same for every pair whose boxes overlap, also where a filter decided: a hundred times slower")
      ->excludes(second);
  command.add_flag("--gap", arguments.gap,
                   "Report the smallest distance of features without a common vertex, over all frames");
  add_what_may_touch(command, arguments);
  command.add_flag("--bodies", arguments.bodies, "Check bodies against each other and themselves too");
  command.add_option("--json", arguments.json, "Write the report as JSON")->type_name("FILE");
  command
      .add_option(
          "--html", arguments.html,
          "Write the report as one page that opens offline: counts, a timeline, and a 3D view of each violation")
      ->type_name("FILE");
  command
      .add_option("--html-mb", arguments.html_mb,
                  "At most this much of meshes in the page: frames with violations first, then some of the others")
      ->check(whole_between(0, 2000))
      ->capture_default_str();
  command
      .add_option("--cases", arguments.cases,
                  "Write each listed violation as a case that selvage replay explains; into a folder without cases")
      ->type_name("DIR");
  command
      .add_option("--max-violations", arguments.max_violations,
                  fmt::format("List at most this many; all are counted (default: {} in the JSON, {} on the terminal)",
                              kViolationsInJson, kViolationsInText))
      ->check(number_between(0, 1e15));  // of what is beyond 2^63 the command line takes the nearest number
  add_long_runs(command, arguments);
  add_threads(command, arguments.threads);
}

std::unique_ptr<io::SequenceReader> open_sequence(const VerifyArguments& arguments) {
  return with_bodies(open_sequence(arguments.sequence), arguments.body, parse_groups(arguments.groups));
}

std::vector<std::string> notes_on_groups(const VerifyArguments& arguments, const io::SequenceReader& sequence) {
  std::vector<std::string> notes;
  for (const io::Group& group : parse_groups(arguments.groups)) {
    if (std::ranges::find(sequence.groups(), group.name, &io::Group::name) == sequence.groups().end()) continue;
    notes.push_back(fmt::format("--group: the sequence has a group \"{}\" of its own; faces {}:{} are added to it",
                                group.name, group.face_begin, group.face_end));
  }
  return notes;
}

verify::SequenceOptions sequence_options(const VerifyArguments& arguments, const io::SequenceReader& sequence) {
  if (arguments.motion && sequence.frame_count() == 1) {
    throw UsageError("--motion needs at least two frames, and there is one: no motion would be checked");
  }
  if (arguments.resume && arguments.json.empty()) throw UsageError("--resume needs --json: progress is kept beside it");
  verify::SequenceOptions options;
  options.check.max_violations = static_cast<std::size_t>(arguments.max_violations.value_or(kViolationsInJson));
  options.check.min_distance = arguments.min_distance;
  options.check.check_bodies = arguments.bodies;
  options.motions = arguments.motion || (!arguments.frames_only && sequence.kind() == io::SequenceKind::kSteps);
  options.rules.groups = parse_groups(arguments.groups);
  for (const std::string& pair : arguments.exempt) options.rules.exempt.push_back(parse_exemption(pair));
  options.rules.ignore = arguments.ignore;
  options.weld = arguments.weld;
  options.gap = arguments.gap;
  options.stop_at_violation = arguments.fail_fast;
  if (arguments.second_opinion) options.check.second_opinion = verify::SecondOpinionScope::kUndecided;
  if (arguments.second_opinion_all) options.check.second_opinion = verify::SecondOpinionScope::kAll;
  if (!arguments.shard.empty()) options.range = frames_of(parse_shard(arguments.shard), sequence.frame_count());
  return options;
}

std::vector<std::pair<std::string, std::string>> recorded_options(const VerifyArguments& arguments,
                                                                  const verify::SequenceOptions& options) {
  return {{"motions", yes_or_no(options.motions)},
          {"min_distance", arguments.min_distance ? fmt::format("{:a}", *arguments.min_distance) : "none"},
          {"bodies", yes_or_no(arguments.bodies)},
          {"gap", yes_or_no(arguments.gap)},
          {"second_opinion", arguments.second_opinion_all ? "all" : yes_or_no(arguments.second_opinion)},
          {"groups", joined(arguments.groups)},
          {"body", joined(arguments.body)},
          {"exempt", joined(arguments.exempt)},
          {"ignore", joined(arguments.ignore)},
          {"weld", yes_or_no(arguments.weld)}};
}

}  // namespace selvage::cli
