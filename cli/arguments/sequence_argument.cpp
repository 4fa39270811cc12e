#include "cli/arguments/sequence_argument.h"

#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include <nlohmann/json.hpp>

#include "cli/arguments/frame_numbers.h"
#include "cli/arguments/output_check.h"
#include "cli/process/exit_code.h"
#include "cli/process/terminal.h"
#include "io/error.h"
#include "io/file/atomic_file.h"
#include "io/point_cache.h"
#include "sim/record/recorder.h"

namespace selvage::cli {

void add_sequence_argument(CLI::App& command, SequenceArgument& argument) {
  command
      .add_option("SEQUENCE", argument.sources,
                  "A sequence folder, an .npz file, a .pc2 or .mdd cache, or mesh files in order")
      ->required();
  command
      .add_option("--base", argument.base,
                  "The mesh that a .pc2 or .mdd moves (default: the .obj or .ply of the same name beside it)")
      ->type_name("MESH");
}

namespace {

/// Of the frames, where each has its own.
std::vector<std::filesystem::path> files_of(const SequenceArgument& argument, const io::SequenceReader& sequence) {
  std::error_code status;
  if (!std::filesystem::is_directory(argument.sources.front(), status)) return argument.sources;
  std::vector<std::filesystem::path> files(sequence.frame_count());
  for (std::size_t frame = 0; frame < files.size(); ++frame) files[frame] = sequence.frame_name(frame);
  return files;
}

/// How a run of `selvage sim` ended, or nothing where it came to its end, or nothing tells.
std::optional<std::string> early_end_of(const std::filesystem::path& folder) {
  std::error_code status;
  if (!std::filesystem::exists(folder / sim::kRunFile, status)) {
    if (!std::filesystem::exists(folder / sim::kCheckpointFile, status)) return std::nullopt;
    return "it was cut off, or goes on";
  }
  try {
    const auto run = nlohmann::json::parse(io::read_file(folder / sim::kRunFile), nullptr, false);
    const auto end = run.is_object() ? run.find("end") : run.end();
    if (end == run.end() || !end->is_string() || *end == "complete") return std::nullopt;
    return end->get<std::string>();
  } catch (const io::Error&) {  // the sequence is readable all the same
    return std::nullopt;
  }
}

}  // namespace

std::unique_ptr<io::SequenceReader> open_sequence(const SequenceArgument& argument) {
  if (!argument.base.empty() && !io::is_point_cache(argument.sources.front())) {
    throw UsageError("--base is for a .pc2 or .mdd; " + argument.sources.front().string() + " has faces of its own");
  }
  auto sequence = io::open_sequence(argument.sources, argument.base);
  print_notes(notes_on(argument, *sequence));
  if (sequence->frame_count() == 0) {
    throw io::Error(io::ErrorKind::kBadInput,
                    argument.sources.front().string() + ": the sequence holds no frame; record one or name another");
  }
  return sequence;
}

std::vector<std::string> notes_on(const SequenceArgument& argument, const io::SequenceReader& sequence) {
  std::vector<std::string> notes;
  if (const auto jump = jump_in_numbers(files_of(argument, sequence))) notes.push_back(*jump);
  if (std::string remark = sequence.remark(); !remark.empty()) notes.push_back(std::move(remark));
  const std::filesystem::path& folder = argument.sources.front();
  if (const auto how = early_end_of(folder)) {
    notes.push_back(folder.string() + ": the run that wrote this did not come to its end (" + *how +
                    "); its last frames are not here");
  }
  return notes;
}

void require_outputs_apart_from(const SequenceArgument& argument, const std::vector<std::filesystem::path>& outputs) {
  std::vector<std::filesystem::path> inputs = io::sequence_files(argument.sources, argument.base);
  for (const std::string_view beside : {sim::kCheckpointFile, sim::kRunFile}) {
    inputs.push_back(argument.sources.front() / beside);
  }
  require_separate_outputs(inputs, outputs);
}

}  // namespace selvage::cli
