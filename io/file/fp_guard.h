// The floating-point environment that reading and writing assume: round to nearest, subnormal numbers kept.
#pragma once

#include <cfenv>

namespace selvage::io {

/// Sets the default environment of the calling thread for a scope and restores what it found. Stands at every public
/// entry that computes with floating-point numbers. Without it every reader gets wrong numbers where the caller rounds
/// otherwise or flushes subnormal numbers (a library linked with -ffast-math does, for the whole process): strtod and
/// from_chars round as they are told, and so does the conversion from float32. About 50 ns.
class FpGuard {
 public:
  FpGuard() noexcept {
    std::fegetenv(&saved_);
    std::fesetenv(FE_DFL_ENV);  // glibc's clears FTZ and DAZ too, and the x87 word that strtod looks at
  }
  ~FpGuard() { std::fesetenv(&saved_); }
  FpGuard(const FpGuard&) = delete;
  FpGuard& operator=(const FpGuard&) = delete;

 private:
  std::fenv_t saved_{};
};

}  // namespace selvage::io
