// `selvage bench sim`: the simulator's time against its error, its growth, and what each module costs.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/process/exit_code.h"

namespace selvage::cli {

/// Adds the subcommand; when it is chosen, parsing sets `job`.
void add_bench_sim_command(CLI::App& bench, Job& job);

}  // namespace selvage::cli
