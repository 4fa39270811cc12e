#include "cli/answer/verdict.h"

#include <algorithm>
#include <cstdio>
#include <string>

#include <fmt/format.h>
#include <unistd.h>

#include "cli/arguments/output_check.h"
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
  const bool is_taken = std::ranges::any_of(reports, is_standard_output);
  const auto print = [is_taken](const std::string& shown) {
    if (is_taken) {
      say_text(shown);
    } else {
      fmt::print("{}", shown);
    }
  };
  if (!use_colour(is_taken ? STDERR_FILENO : STDOUT_FILENO)) return print(text);
  const char* colour = verdict == verify::Verdict::kClean ? "\033[32m" : "\033[31m";
  const std::size_t first_line = text.find('\n');
  print(colour + text.substr(0, first_line) + "\033[0m" + text.substr(first_line));
}

}  // namespace selvage::cli
