#include "cli/verify_command.h"

#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/answer/case_output.h"
#include "cli/answer/enclosed_cloth.h"
#include "cli/answer/mesh_faults.h"
#include "cli/answer/result.h"
#include "cli/answer/verdict.h"
#include "cli/answer/verify_progress.h"
#include "cli/arguments/output_check.h"
#include "cli/arguments/thread_limit.h"
#include "cli/arguments/verify_arguments.h"
#include "cli/command.h"
#include "cli/page/report_page.h"
#include "cli/process/interrupt.h"
#include "cli/process/terminal.h"
#include "kernel/version.h"
#include "verify/report/report.h"

namespace selvage::cli {
namespace {

verify::ReportContext report_context(const VerifyArguments& arguments, const io::SequenceReader& sequence,
                                     const verify::SequenceOptions& options) {
  verify::ReportContext context{
      std::string("selvage ") + SELVAGE_VERSION, {}, {}, recorded_options(arguments, options)};
  for (const std::filesystem::path& source : arguments.sequence.sources) context.sources.push_back(source.string());
  for (std::size_t i = 0; i < sequence.frame_count(); ++i) context.frame_names.emplace(i, sequence.frame_name(i));
  context.notes = notes_on(arguments.sequence, sequence);
  const std::vector<std::string> on_groups = notes_on_groups(arguments, sequence);
  context.notes.insert(context.notes.end(), on_groups.begin(), on_groups.end());
  return context;
}

std::pair<std::size_t, std::size_t> range_of(const io::SequenceReader& sequence,
                                             const verify::SequenceOptions& options) {
  return options.range.value_or(std::pair<std::size_t, std::size_t>(0, sequence.frame_count()));
}

/// Not of one frame under a name that is too long for it: nothing could be gone on from before the report is there.
bool keeps_progress(const VerifyArguments& arguments, const io::SequenceReader& sequence,
                    const verify::SequenceOptions& options) {
  if (arguments.json.empty()) return false;
  const auto [first, end] = range_of(sequence, options);
  return end - first > 1 || VerifyProgress::can_keep(arguments.json);
}

/// With a report file, progress is kept beside it until the run is complete.
verify::SequenceReport check(const VerifyArguments& arguments, const io::SequenceReader& sequence,
                             verify::SequenceOptions options, const verify::ReportContext& context) {
  VerifyProgress progress(arguments.json, context);
  std::optional<verify::SequenceReport> earlier;
  if (arguments.resume) {
    const auto [first, end] = range_of(sequence, options);
    earlier = progress.load({verify::sequence_identity(sequence), static_cast<std::int64_t>(first),
                             static_cast<std::int64_t>(end), static_cast<std::int64_t>(options.check.max_violations)});
  }
  options.resume_from = earlier ? &*earlier : nullptr;
  ProgressBar bar("verify");
  options.progress = [&](std::size_t done, std::size_t total) {
    bar.update(done, total);
    return !interrupted();
  };
  options.check.stop = interrupted;
  if (keeps_progress(arguments, sequence, options))
    options.checkpoint = [&](const auto& report) { progress.note(report); };
  const auto and_what_is_kept = [&](const std::string& what) {
    if (!progress.flush()) return what;
    return what + " (what was checked before it is kept in " + progress.file().string() +
           "; --resume goes on from there)";
  };
  try {
    verify::SequenceReport report = verify::check_sequence(sequence, options);
    if (!is_complete(report)) (void)progress.flush();
    return report;
  } catch (const verify::GroupRuleError& error) {
    throw UsageError(and_what_is_kept(error.what()));
  } catch (const io::Error& error) {
    throw io::Error(error.kind(), and_what_is_kept(error.what()));
  }
}

/// Of what was found clean. Where the motion was checked too, what is inside at first is inside at last. Faces that may
/// touch by a rule, or are left out, leave no inside.
std::vector<std::string> notes_on_clean(const VerifyArguments& arguments, const io::SequenceReader& sequence,
                                        const verify::SequenceOptions& options, const verify::SequenceReport& report) {
  const bool has_rules = !arguments.exempt.empty() || !arguments.ignore.empty();
  if (report.verdict != verify::Verdict::kClean || has_rules || report.frames.checked == 0) return {};
  const auto first = static_cast<std::size_t>(report.first_frame),
             last = static_cast<std::size_t>(report.end_frame) - 1;
  return notes_on_enclosed(sequence, first, options.motions ? first : last);
}

/// Before the check, which may take hours.
void require_writable_outputs(const VerifyArguments& arguments) {
  require_writable({arguments.json, arguments.html});
  if (arguments.cases.empty()) return;
  create_case_folder(arguments.cases);
  require_writable({arguments.json, arguments.html});  // once more: a report may have the name of a folder above
  if (!arguments.resume && arguments.shard.empty()) require_no_cases(arguments.cases);  // else some are of this check
  require_writable({arguments.cases / "a.case"});
}

/// The cases first: the report names their files.
void write_outputs(const VerifyArguments& arguments, const io::SequenceReader& sequence,
                   const verify::ReportContext& context, verify::SequenceReport& report) {
  if (!arguments.cases.empty()) {
    write_cases(arguments.cases, arguments.min_distance.value_or(0), report.violations);
  }
  if (!report.disagreements.empty()) {  // evidence against the checker itself: kept whether or not it was asked for
    write_cases(arguments.cases.empty() ? "disagreements" : arguments.cases, 0, report.disagreements);
  }
  if (!arguments.json.empty()) {
    write_report(arguments.json, verify::json_report(report, context));
    if (is_complete(report)) VerifyProgress(arguments.json, context).remove();
  }
  if (!arguments.html.empty()) {
    const ReportPageOptions page{arguments.min_distance.value_or(0),
                                 static_cast<std::size_t>(arguments.html_mb) * 1000 * 1000};
    write_report(arguments.html, report_page(report, context, &sequence, page));
  }
}

ExitCode run(const VerifyArguments& arguments) {
  catch_interrupts();
  const auto threads = arguments.threads.hold();
  std::filesystem::path progress;
  if (!arguments.json.empty() && VerifyProgress::can_keep(arguments.json)) {
    progress = VerifyProgress::file_of(arguments.json);
  }
  require_outputs_apart_from(arguments.sequence, {arguments.json, progress, arguments.html});
  for (const std::filesystem::path& file :
       std::vector<std::filesystem::path>{arguments.json, progress, arguments.html}) {
    if (file.empty() || arguments.cases.empty() || !is_one_file(file, arguments.cases)) continue;
    throw UsageError(file.string() + " is named for a report and for the folder of --cases; name another");
  }
  const auto sequence = open_sequence(arguments);
  const verify::SequenceOptions options = sequence_options(arguments, *sequence);
  verify::ReportContext context = report_context(arguments, *sequence, options);
  print_notes(notes_on_groups(arguments, *sequence));
  if (keeps_progress(arguments, *sequence, options)) VerifyProgress::require_name(arguments.json);
  require_writable_outputs(arguments);
  verify::SequenceReport report = check(arguments, *sequence, options, context);
  std::vector<std::string> on_result = notes_on_clean(arguments, *sequence, options, report);
  if (auto on_polygons = note_on_polygons(*sequence, report)) on_result.push_back(std::move(*on_polygons));
  print_notes(on_result);
  context.notes.insert(context.notes.end(), on_result.begin(), on_result.end());
  const auto print = [&] {
    const auto max_listed = static_cast<std::size_t>(arguments.max_violations.value_or(kViolationsInText));
    print_report(verify::text_report(report, context, max_listed), report.verdict, {arguments.json, arguments.html});
  };
  try {
    write_outputs(arguments, *sequence, context, report);
  } catch (const std::exception&) {
    print();  // a disk that is full costs the files, not the verdict
    throw;
  }
  print();
  return exit_code(report);
}

}  // namespace

void add_verify_command(CLI::App& program, Job& job) {
  CLI::App& command =
      add_command(program, "verify", "Check a mesh sequence exactly: frames, and the motion between them",
                  "selvage verify run/ --json report.json");
  const auto arguments = std::make_shared<VerifyArguments>();
  add_verify_arguments(command, *arguments);
  command.callback([arguments, &job] { job = [arguments] { return run(*arguments); }; });
}

}  // namespace selvage::cli
