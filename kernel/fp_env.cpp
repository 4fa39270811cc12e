#include "kernel/fp_env.h"

#if defined(__SSE2__)
#include <xmmintrin.h>
#else
#include <cfenv>
#endif

namespace selvage {

#if defined(__SSE2__)

namespace {
// MXCSR (Intel SDM, volume 1, 10.2.3): DAZ bit 6, exception masks bits 7-12, rounding bits 13-14, FTZ bit 15.
// Masks belong to the environment: with traps enabled, a harmless 0/0 on the way to "unresolved" would end the process.
constexpr unsigned kControlBits = 0xffc0;
constexpr unsigned kControlWanted = 0x1f80;  // to nearest, neither FTZ nor DAZ, every exception masked
}  // namespace

FpEnvGuard::FpEnvGuard() noexcept : saved_(_mm_getcsr()), repaired_((saved_ & kControlBits) != kControlWanted) {
  if (repaired_) _mm_setcsr((saved_ & ~kControlBits) | kControlWanted);
}

FpEnvGuard::~FpEnvGuard() {
  if (repaired_) _mm_setcsr(saved_);
}

#else

// Elsewhere only the rounding direction can be set portably; fp_env_defects() reports what remains.
FpEnvGuard::FpEnvGuard() noexcept
    : saved_(static_cast<unsigned>(std::fegetround())), repaired_(std::fegetround() != FE_TONEAREST) {
  if (repaired_) std::fesetround(FE_TONEAREST);
}

FpEnvGuard::~FpEnvGuard() {
  if (repaired_) std::fesetround(static_cast<int>(saved_));
}

#endif

}  // namespace selvage
