// A verdict of the checker as the program's exit code and on its standard output.
#pragma once

#include <string>

#include "cli/exit_code.h"
#include "verify/check.h"

namespace selvage::cli {

/// Unknown is kLimit, or kInterrupted where a signal has arrived.
[[nodiscard]] ExitCode exit_code(verify::Verdict verdict);
/// Prints verify::text_report(); the first line, which is the verdict, coloured on a terminal.
void print_report(const std::string& text, verify::Verdict verdict);

}  // namespace selvage::cli
