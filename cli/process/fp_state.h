// The floating-point environment the program was started in, in words, and whether it can be worked in.
#pragma once

#include <string>
#include <vector>

namespace selvage::cli {

/// Of an OR of FpEnvDefect (kernel/fp_env.h), what each is; empty if sound.
[[nodiscard]] std::vector<std::string> describe_fp_defects(unsigned defects);

/// To be called under an FpEnvGuard. `as_found` is what fp_env_defects() said before it. Throws FpEnvironmentError if
/// something is wrong still; says on stderr what was repaired.
void require_sound_fp(unsigned as_found);

}  // namespace selvage::cli
