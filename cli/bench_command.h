// selvage bench: speed against error on files of queries (queries) and on the candidates of a motion (ccd).
#pragma once

#include <CLI/CLI.hpp>

#include "cli/process/exit_code.h"

namespace selvage::cli {

void add_bench_command(CLI::App& program, Job& job);

}  // namespace selvage::cli
