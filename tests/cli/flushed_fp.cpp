// Linked into a copy of the program, this does what GCC's start-up code for -ffast-math does: FTZ and DAZ before main.
#if defined(__SSE2__)
#include <xmmintrin.h>

namespace {

[[gnu::constructor]] void flush_to_zero() { _mm_setcsr(_mm_getcsr() | 0x8040); }

}  // namespace
#endif
