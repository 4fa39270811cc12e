#include "verify/arithmetic/fp_guard.h"

#if defined(__x86_64__)
#include <xmmintrin.h>
#elif !defined(__aarch64__)
#error "no floating-point guard for this processor: write one here"
#endif

namespace selvage::verify {
namespace {

// With an exception unmasked, what overflows on the way to a filter's "unclear" would end the process.
#if defined(__x86_64__)
// MXCSR: DAZ bit 6, exception masks bits 7-12, rounding mode bits 13-14 (0: to nearest), FTZ bit 15.
constexpr unsigned kControlBits = 0xffc0;
constexpr unsigned kControlWanted = 0x1f80;

unsigned read_control() { return _mm_getcsr(); }
void write_control(unsigned control) { _mm_setcsr(control); }
#else
// FPCR: FIZ, AH and NEP bits 0-2 (of newer processors), exception traps bits 8-12 and 15, rounding mode bits 22-23 (0:
// to nearest), FZ bit 24.
constexpr unsigned kControlBits = 0x01c09f07;
constexpr unsigned kControlWanted = 0;

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

FpGuard::FpGuard() noexcept : saved_(read_control()) {
  if ((saved_ & kControlBits) != kControlWanted) write_control((saved_ & ~kControlBits) | kControlWanted);
}
// Also what was changed inside the scope, as a second decider or a caller's function may.
FpGuard::~FpGuard() {
  if (((read_control() ^ saved_) & kControlBits) != 0) write_control(saved_);
}

}  // namespace selvage::verify
