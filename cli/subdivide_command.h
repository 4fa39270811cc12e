// selvage subdivide: finer and smoother frames without intersections.
#pragma once

#include "cli/command.h"

namespace selvage::cli {

void add_subdivide_command(CLI::App& program, Job& job);

}  // namespace selvage::cli
