// selvage doctor: whether this machine and this process compute as the proofs assume.
#pragma once

#include "cli/command.h"

namespace selvage::cli {

/// `fp_as_found`: fp_env_defects() at the start of the program, before any guard.
void add_doctor_command(CLI::App& program, Job& job, unsigned fp_as_found);

}  // namespace selvage::cli
