// selvage render: a contact sheet of a sequence as one PNG.
#pragma once

#include "cli/command.h"

namespace selvage::cli {

void add_render_command(CLI::App& program, Job& job);

}  // namespace selvage::cli
