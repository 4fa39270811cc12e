#include "verify/arithmetic/fp_guard.h"

#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) ||                     \
    (defined(__FLT_EVAL_METHOD__) && (__FLT_EVAL_METHOD__ < 0 || __FLT_EVAL_METHOD__ == 2))
#error \
    "the checker's filters are proved for IEEE doubles: do not compile with parts of -ffast-math, or for the x87 unit"
#endif

#if defined(__x86_64__)
#include <xmmintrin.h>

namespace selvage::verify {
namespace {

// MXCSR: rounding mode in bits 13-14 (0: to nearest), FTZ bit 15, DAZ bit 6.
constexpr unsigned kUnwanted = 0x6000U | 0x8000U | 0x0040U;

}  // namespace

FpGuard::FpGuard() noexcept : saved_(_mm_getcsr()) {
  if ((saved_ & kUnwanted) != 0) _mm_setcsr(saved_ & ~kUnwanted);
}
FpGuard::~FpGuard() {
  if ((saved_ & kUnwanted) != 0) _mm_setcsr(saved_);
}

}  // namespace selvage::verify

#elif defined(__aarch64__)

namespace selvage::verify {
namespace {

// FPCR: rounding mode in bits 22-23 (0: to nearest), FZ bit 24.
constexpr unsigned long kUnwanted = 0x01C00000UL;

unsigned long read_fpcr() {
  unsigned long value = 0;
  asm volatile("mrs %0, fpcr" : "=r"(value));
  return value;
}
void write_fpcr(unsigned long value) { asm volatile("msr fpcr, %0" : : "r"(value)); }

}  // namespace

FpGuard::FpGuard() noexcept : saved_(static_cast<unsigned>(read_fpcr())) {
  if ((saved_ & kUnwanted) != 0) write_fpcr(saved_ & ~kUnwanted);
}
FpGuard::~FpGuard() {
  if ((saved_ & kUnwanted) != 0) write_fpcr(saved_);
}

}  // namespace selvage::verify

#else
#error "no floating-point guard for this processor: write one here"
#endif
