// `selvage bench`: speed against error. Each benchmark is a subcommand with a file of its own.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/process/exit_code.h"

namespace selvage::cli {

void add_bench_command(CLI::App& program, Job& job);

}  // namespace selvage::cli
