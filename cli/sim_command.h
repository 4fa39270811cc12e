// selvage sim: simulates a scene into a sequence folder.
#pragma once

#include "cli/command.h"

namespace selvage::cli {

void add_sim_command(CLI::App& program, Job& job);

}  // namespace selvage::cli
