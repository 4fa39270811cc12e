// The control register of the floating-point unit: what a library linked with -ffast-math does to it, <cfenv> cannot.
#pragma once

#include <cfenv>

namespace selvage::testing {

#if defined(__x86_64__)
// MXCSR (Intel SDM, volume 1, 10.2.3)
inline constexpr auto kFpControl = &std::fenv_t::__mxcsr;
inline constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040;
inline constexpr unsigned kFlushing = kFlushToZero | kDenormalsAreZero;
inline constexpr unsigned kRoundUp = 0x4000, kRoundDown = 0x2000, kRoundToZero = 0x6000;
inline constexpr unsigned kExceptionFlags = 0x3f;
#elif defined(__aarch64__)
// FPCR (Arm ARM, C5.2.8): FZ, which takes subnormal operands for zero as well; flags have a register of their own.
inline constexpr auto kFpControl = &std::fenv_t::__fpcr;
inline constexpr unsigned kFlushing = 1U << 24, kFlushToZero = kFlushing;
inline constexpr unsigned kRoundUp = 1U << 22, kRoundDown = 2U << 22, kRoundToZero = 3U << 22;
inline constexpr unsigned kExceptionFlags = 0;
#else
#error "which bits of this processor flush subnormal numbers and set the rounding: say so here"
#endif

inline unsigned fp_control() {
  std::fenv_t environment;
  std::fegetenv(&environment);
  return environment.*kFpControl;
}
inline void set_fp_control(unsigned control) {
  std::fenv_t environment;
  std::fegetenv(&environment);
  environment.*kFpControl = control;
  std::fesetenv(&environment);
}

}  // namespace selvage::testing
