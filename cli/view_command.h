// selvage view: a sequence as a page that plays it.
#pragma once

#include "cli/command.h"

namespace selvage::cli {

void add_view_command(CLI::App& program, Job& job);

}  // namespace selvage::cli
