// Linked into a copy of the program, this takes the place of the kernel's probes: a machine that fuses, guard or not.
#include "kernel/fp_env.h"

namespace selvage {

unsigned fp_env_defects() noexcept { return kFpContracted; }

}  // namespace selvage
