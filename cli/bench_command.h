// selvage bench queries: speed against error on files of queries.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/exit_code.h"

namespace selvage::cli {

void add_bench_command(CLI::App& program, Job& job);

}  // namespace selvage::cli
