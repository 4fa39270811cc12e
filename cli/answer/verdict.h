// A verdict of the checker as the program's exit code and on its standard output.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/process/exit_code.h"
#include "verify/check.h"

namespace selvage::cli {

/// kInterrupted where a signal has left work undone, whatever was found before: only resumed is the answer whole.
/// Otherwise the verdict's; unknown is kLimit, and kInternal where two deciders disagree.
[[nodiscard]] ExitCode exit_code(const verify::SequenceReport& report);
/// Prints verify::text_report(); the first line, which is the verdict, coloured on a terminal. On stderr where one of
/// the `reports` is what stdout goes to: whoever reads it there gets that file and nothing else.
void print_report(const std::string& text, verify::Verdict verdict,
                  const std::vector<std::filesystem::path>& reports = {});

}  // namespace selvage::cli
