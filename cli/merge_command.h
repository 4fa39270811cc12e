// selvage merge: joins the reports of shards.
#pragma once

#include <CLI/CLI.hpp>

#include "cli/process/exit_code.h"

namespace selvage::cli {

void add_merge_command(CLI::App& program, Job& job);

}  // namespace selvage::cli
