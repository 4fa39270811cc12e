// The floating-point environment that the checker's filters assume: round to nearest, no flush to zero, no
// denormals-are-zero, no traps. The checker has its own guard because it shares nothing with the kernel (V2).
#pragma once

#include "verify/arithmetic/sound_arithmetic.h"

namespace selvage::verify {

/// Sets the environment of the calling thread for a scope and restores what it found, whatever was changed inside.
/// Stands at every public entry of the checker and at the start of every worker task: a library linked with -ffast-math
/// changes FTZ and DAZ of the process, and CGAL's interval arithmetic changes the rounding mode.
class FpGuard {
 public:
  FpGuard() noexcept;
  ~FpGuard();
  FpGuard(const FpGuard&) = delete;
  FpGuard& operator=(const FpGuard&) = delete;

 private:
  unsigned saved_;
};

}  // namespace selvage::verify
