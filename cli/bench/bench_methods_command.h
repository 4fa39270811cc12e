// `selvage bench methods`: every method at every setting on typical cloth and on the hard classes.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/process/exit_code.h"

namespace selvage::cli {

/// Adds the subcommand; when it is chosen, parsing sets `job`.
void add_bench_methods_command(CLI::App& bench, Job& job);

}  // namespace selvage::cli
