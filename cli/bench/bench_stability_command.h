// `selvage bench stability`: the suite of hard cases.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/process/exit_code.h"

namespace selvage::cli {

/// Adds the subcommand; when it is chosen, parsing sets `job`.
void add_bench_stability_command(CLI::App& bench, Job& job);

}  // namespace selvage::cli
