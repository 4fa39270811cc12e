#include "kernel/fp_env.h"

#if defined(__SSE2__)
#include <xmmintrin.h>
#elif !defined(__aarch64__)
#include <cfenv>
#endif

namespace selvage {

#if defined(__SSE2__) || defined(__aarch64__)

// Exception masks belong to the environment: with traps enabled, a harmless 0/0 on the way to "unresolved" would end
// the process.
namespace {

#if defined(__SSE2__)
// MXCSR (Intel SDM, volume 1, 10.2.3): DAZ bit 6, exception masks bits 7-12, rounding bits 13-14, FTZ bit 15.
constexpr unsigned kControlBits = 0xffc0;
constexpr unsigned kControlWanted = 0x1f80;  // to nearest, neither FTZ nor DAZ, every exception masked

unsigned read_control() { return _mm_getcsr(); }
void write_control(unsigned control) { _mm_setcsr(control); }
#else
// FPCR (Arm ARM, C5.2.8): FIZ, AH and NEP bits 0-2 (where the processor has FEAT_AFP, else zero), exception traps bits
// 8-12 and 15, rounding bits 22-23, FZ bit 24.
constexpr unsigned kControlBits = 0x01c09f07;
constexpr unsigned kControlWanted = 0;  // to nearest, no flush to zero of inputs or results, no trap

unsigned read_control() {
  unsigned long control = 0;
  asm volatile("mrs %0, fpcr" : "=r"(control));
  return static_cast<unsigned>(control);
}
void write_control(unsigned control) {
  asm volatile("msr fpcr, %0" : : "r"(static_cast<unsigned long>(control)) : "memory");
}
#endif

}  // namespace

FpEnvGuard::FpEnvGuard() noexcept : saved_(read_control()), repaired_((saved_ & kControlBits) != kControlWanted) {
  if (repaired_) write_control((saved_ & ~kControlBits) | kControlWanted);
}

// Also what was changed inside the scope, as a caller's function may.
FpEnvGuard::~FpEnvGuard() {
  if (((read_control() ^ saved_) & kControlBits) != 0) write_control(saved_);
}

#else

// Elsewhere only the rounding direction can be set portably; fp_env_defects() reports what remains.
FpEnvGuard::FpEnvGuard() noexcept
    : saved_(static_cast<unsigned>(std::fegetround())), repaired_(std::fegetround() != FE_TONEAREST) {
  if (repaired_) std::fesetround(FE_TONEAREST);
}

FpEnvGuard::~FpEnvGuard() { std::fesetround(static_cast<int>(saved_)); }

#endif

}  // namespace selvage
