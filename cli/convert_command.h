// selvage convert: a sequence in another format, checked as written if asked for.
#pragma once

#include "cli/command.h"

namespace selvage::cli {

void add_convert_command(CLI::App& program, Job& job);

}  // namespace selvage::cli
