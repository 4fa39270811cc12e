#include "cli/replay_command.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cli/command.h"
#include "cli/output_check.h"
#include "cli/replay.h"
#include "io/atomic_file.h"

namespace selvage::cli {
namespace {

struct Arguments {
  std::vector<std::filesystem::path> cases;
  std::string json;
};

constexpr std::size_t kLargestCase = 1 << 20;

Explanation replay(const std::filesystem::path& file) {
  const std::string text = io::read_file(file, kLargestCase), name = file.string();
  const std::string kind = fuzz::kind_of_case(text, name);
  if (kind == "overlap") return explain(name, replay_overlap(fuzz::parse_overlap_case(text, name)));
  const auto is_motion = [&](PairKind pair) { return fuzz::name_of(pair) == kind; };
  if (std::ranges::any_of(fuzz::kPairKinds, is_motion))
    return explain(name, replay_motion(fuzz::parse_case(text, name)));
  return explain(name, replay_kept(name, fuzz::parse_kept_case(text, name)));
}

/// The gravest one counts.
ExitCode exit_code(const std::vector<Explanation>& explanations) {
  ExitCode code = ExitCode::kClean;
  for (const Explanation& explanation : explanations) {
    switch (explanation.outcome) {
      case ReplayOutcome::kAgree:
        break;
      case ReplayOutcome::kBroken:
        if (code == ExitCode::kClean) code = ExitCode::kViolation;
        break;
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

ExitCode run(const Arguments& arguments) {
  std::vector<std::filesystem::path> files;
  for (const std::filesystem::path& named : arguments.cases) {
    if (!std::filesystem::is_directory(named)) {
      files.push_back(named);
      continue;
    }
    const std::vector<std::filesystem::path> found = fuzz::case_files(named);
    if (found.empty()) throw io::Error(io::ErrorKind::kBadInput, named.string() + ": holds no case (*.case)");
    files.insert(files.end(), found.begin(), found.end());
  }
  require_separate_outputs(files, {arguments.json});
  std::vector<Explanation> explanations;
  std::string json = "{\n\"schema\": \"selvage.replay/1\",\n\"cases\": [";
  for (const std::filesystem::path& file : files) {
    explanations.push_back(replay(file));
    fmt::print("{}", explanations.back().text);
    json += (explanations.size() > 1 ? ",\n" : "\n") + explanations.back().json;
  }
  if (!arguments.json.empty()) io::write_atomically(arguments.json, json + "\n]\n}\n");
  return exit_code(explanations);
}

}  // namespace

void add_replay_command(CLI::App& program, Job& job) {
  CLI::App& command =
      add_command(program, "replay",
                  "Explain kept cases: of a query the kernel's answer, the exact one and the textbook's, "
                  "and where they differ; of a step, a mesh, a scene or a file what happens when it is "
                  "run again, and which promise breaks. Exit code 1 if a promise is broken, 3 if a case "
                  "expects another answer than the exact one, 7 if two exact deciders differ",
                  "selvage replay failure.case");
  const auto arguments = std::make_shared<Arguments>();
  command.add_option("CASE", arguments->cases, "Case files, or folders of them")->required();
  command.add_option("--json", arguments->json, "Write the explanations as JSON")->type_name("FILE");
  command.callback([arguments, &job] { job = [arguments] { return run(*arguments); }; });
}

}  // namespace selvage::cli
