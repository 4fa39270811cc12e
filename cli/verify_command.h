// selvage verify: checks stored sequences exactly.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/process/exit_code.h"

namespace selvage::cli {

void add_verify_command(CLI::App& program, Job& job);

}  // namespace selvage::cli
