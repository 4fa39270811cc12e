// selvage replay: one kept case, seen by the kernel, by exact arithmetic and by the textbook's method.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/process/exit_code.h"

namespace selvage::cli {

void add_replay_command(CLI::App& program, Job& job);

}  // namespace selvage::cli
