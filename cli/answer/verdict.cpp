#include "cli/answer/verdict.h"

#include <string>

#include <unistd.h>

#include "cli/answer/result.h"
#include "cli/process/interrupt.h"
#include "cli/process/terminal.h"

namespace selvage::cli {

ExitCode exit_code(const verify::SequenceReport& report) {
  if (interrupted() && !is_complete(report)) return ExitCode::kInterrupted;
  if (report.pairs.disagreed > 0) return ExitCode::kInternal;
  switch (report.verdict) {
    case verify::Verdict::kClean:
      return ExitCode::kClean;
    case verify::Verdict::kViolated:
      return ExitCode::kViolation;
    case verify::Verdict::kUnknown:
      return ExitCode::kLimit;
  }
  return ExitCode::kInternal;
}

void print_report(const std::string& text, verify::Verdict verdict, const std::vector<std::filesystem::path>& reports) {
  if (!use_colour(is_stdout_taken(reports) ? STDERR_FILENO : STDOUT_FILENO)) return print_result(text, reports);
  const char* colour = verdict == verify::Verdict::kClean ? "\033[32m" : "\033[31m";
  const std::size_t first_line = text.find('\n');
  print_result(colour + text.substr(0, first_line) + "\033[0m" + text.substr(first_line), reports);
}

}  // namespace selvage::cli
