// selvage fuzz: campaigns of constructed queries against the kernel, judged by exact arithmetic.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/process/exit_code.h"

namespace selvage::cli {

void add_fuzz_command(CLI::App& program, Job& job);

}  // namespace selvage::cli
