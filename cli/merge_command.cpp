#include "cli/merge_command.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "cli/answer/merge_campaigns.h"
#include "cli/answer/result.h"
#include "cli/answer/verdict.h"
#include "cli/arguments/output_check.h"
#include "cli/command.h"
#include "cli/page/report_page.h"
#include "cli/process/exit_code.h"
#include "cli/process/terminal.h"
#include "io/file/atomic_file.h"
#include "verify/report/merge.h"

namespace selvage::cli {
namespace {

namespace fs = std::filesystem;

struct MergeArguments {
  std::vector<std::string> sources;
  std::string output, html;
};

/// Whether it is a report on some of the frames.
bool is_part(const fs::path& file) {
  const verify::SequenceReport report = verify::parse_report(io::read_file(file), file.string()).report;
  return report.first_frame > 0 || report.end_frame < report.frame_count;
}

/// The reports of a folder: all its .json files but the output, which an earlier merge may have left there. One of the
/// parts is none, nor what is alone there: it would be overwritten, and the frames of it missed.
std::vector<fs::path> reports_in(const fs::path& folder, const fs::path& output) {
  std::vector<fs::path> files;
  bool holds_output = false;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".json") continue;
    std::error_code absent;
    if (fs::equivalent(entry.path(), output, absent)) {
      holds_output = true;
    } else {
      files.push_back(entry.path());
    }
  }
  if (holds_output && (files.empty() || is_part(output))) {
    throw UsageError(output.string() + " is a report of " + folder.string() +
                     " that is read, and would be overwritten; name another file");
  }
  if (files.empty()) {
    throw io::Error(io::ErrorKind::kBadInput,
                    folder.string() +
                        ": holds no report (*.json); name the folder where selvage verify --shard i/N "
                        "--json FILE wrote them, or each folder of selvage fuzz --shard i/N");
  }
  std::sort(files.begin(), files.end());
  return files;
}

ExitCode run(const MergeArguments& arguments) {
  const std::vector<fs::path> sources(arguments.sources.begin(), arguments.sources.end());
  if (are_campaigns(sources)) return merge_campaigns(sources, arguments.output);
  std::vector<fs::path> files;
  for (const std::string& source : arguments.sources) {
    if (fs::is_directory(source)) {
      const std::vector<fs::path> found = reports_in(source, arguments.output);
      files.insert(files.end(), found.begin(), found.end());
    } else {
      files.emplace_back(source);
    }
  }
  require_outputs(files, {arguments.output, arguments.html});
  std::vector<verify::Part> parts;
  for (const fs::path& file : files) {
    parts.push_back({file.string(), verify::parse_report(io::read_file(file), file.string())});
  }
  verify::ParsedReport merged;
  try {
    merged = verify::merge(std::move(parts));
  } catch (const verify::MergeError& error) {
    throw io::Error(io::ErrorKind::kBadInput, error.what());
  }
  write_report(arguments.output, verify::json_report(merged.report, merged.context));
  if (!arguments.html.empty()) {
    write_report(arguments.html, report_page(merged.report, merged.context, nullptr, {}));
  }
  print_notes(merged.context.notes);
  constexpr std::size_t kMaxListed = 10;  // as selvage verify does on a terminal
  print_report(verify::text_report(merged.report, merged.context, kMaxListed), merged.report.verdict,
               {arguments.output, arguments.html});
  return exit_code(merged.report);
}

}  // namespace

void add_merge_command(CLI::App& program, Job& job) {
  CLI::App& command = add_command(
      program, "merge", "Join what shards of selvage verify or selvage fuzz have done: all of them, or it is an error",
      "selvage merge shards/ -o report.json");
  const auto arguments = std::make_shared<MergeArguments>();
  command
      .add_option("REPORT", arguments->sources,
                  "Reports of selvage verify --shard or folders of them; or folders of selvage fuzz --shard")
      ->required();
  command
      .add_option("-o,--output", arguments->output,
                  "The report on the whole sequence, or the folder of the whole campaign")
      ->type_name("FILE")
      ->required();
  command
      .add_option("--html", arguments->html,
                  "Write it as a page too; without the meshes, for the reports do not hold them: the witnesses alone")
      ->type_name("FILE");
  command.callback([arguments, &job] { job = [arguments] { return run(*arguments); }; });
}

}  // namespace selvage::cli
