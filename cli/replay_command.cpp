#include "cli/replay_command.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/answer/replay.h"
#include "cli/answer/result.h"
#include "cli/arguments/number_check.h"
#include "cli/arguments/output_check.h"
#include "cli/command.h"
#include "io/file/atomic_file.h"

namespace selvage::cli {
namespace {

struct ReplayArguments {
  std::vector<std::filesystem::path> cases;
  std::string json, plugin;
  double case_time_s = fuzz::kCaseSeconds;
};

constexpr std::size_t kLargestCase = 1 << 20;

/// The gravest one counts.
ExitCode exit_code_of(const std::vector<Explanation>& explanations) {
  ExitCode code = ExitCode::kClean;
  for (const Explanation& explanation : explanations) {
    switch (explanation.outcome) {
      case ReplayOutcome::kAgree:
        break;
      case ReplayOutcome::kBroken:
        if (code == ExitCode::kClean) code = ExitCode::kViolation;
        break;
      case ReplayOutcome::kOutside:
      case ReplayOutcome::kContradicted:
        if (code != ExitCode::kInternal) code = ExitCode::kBadInput;
        break;
      case ReplayOutcome::kDivided:
        code = ExitCode::kInternal;
        break;
    }
  }
  return code;
}

ExitCode run(const ReplayArguments& arguments) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& named : arguments.cases) {
    if (!std::filesystem::is_directory(named)) {
      files.push_back(named);
      continue;
    }
    const std::vector<std::filesystem::path> found = fuzz::case_files(named);
    if (found.empty())
      throw io::Error(io::ErrorKind::kBadInput,
                      named.string() + ": holds no case (*.case); name one, or a folder of cases");
    files.insert(files.end(), found.begin(), found.end());
  }
  std::vector<std::filesystem::path> inputs = files;
  std::optional<PluginToAsk> asked;
  if (!arguments.plugin.empty()) {
    asked = {arguments.plugin, arguments.case_time_s};
    inputs.emplace_back(arguments.plugin);
  }
  require_outputs(inputs, {arguments.json});
  int for_plugins = 0;
  std::vector<Explanation> explanations;
  std::string json = "{\n\"schema\": \"selvage.replay/1\",\n\"cases\": [";
  for (const std::filesystem::path& file : files) {
    const std::string text = io::read_file(file, kLargestCase), name = file.string();
    explanations.push_back(replay_text(text, name, asked));
    print_result(explanations.back().text, {arguments.json});
    const bool is_asked = is_for_plugins(fuzz::kind_of_case(text, name));
    for_plugins += is_asked ? 1 : 0;
    if (asked && !is_asked) print_result("  the plugin was not asked: it answers vf and ee alone\n", {arguments.json});
    json += (explanations.size() > 1 ? ",\n" : "\n") + explanations.back().json;
  }
  if (asked && for_plugins == 0) {
    throw io::Error(io::ErrorKind::kBadInput, arguments.plugin + ": was asked nothing; name a case of vf or ee");
  }
  if (!arguments.json.empty()) write_report(arguments.json, json + "\n]\n}\n");
  return exit_code_of(explanations);
}

}  // namespace

void add_replay_command(CLI::App& program, Job& job) {
  CLI::App& command =
      add_command(program, "replay",
                  "Explain kept cases: of a query the kernel's answer, the exact one and the textbook's, "
                  "and where they differ; of a step, a mesh, a scene or a file what happens when it is "
                  "run again, and which promise breaks. Exit code 1 if a promise is broken, 3 if a case "
                  "expects another answer than the exact one, or a coordinate is beyond the domain (2^1000), 7 if "
                  "two exact deciders differ",
                  "selvage replay failure.case");
  const auto arguments = std::make_shared<ReplayArguments>();
  command.add_option("CASE", arguments->cases, "Case files, or folders of them")->required();
  command
      .add_option("--plugin", arguments->plugin,
                  "Ask this collision code as well, as `selvage fuzz --plugin` does, and judge what it answers")
      ->type_name("LIB.so");
  command
      .add_option("--case-time", arguments->case_time_s,
                  "Seconds that the plugin may compute and sleep over a case, or being loaded, before that is a hang")
      ->check(number_above(0))
      ->capture_default_str();
  command.add_option("--json", arguments->json, "Write the explanations as JSON")->type_name("FILE");
  command.callback([arguments, &job] { job = [arguments] { return run(*arguments); }; });
}

}  // namespace selvage::cli
