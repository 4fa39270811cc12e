#include "cli/process/hostile_fp.h"

#include <cfenv>

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

namespace selvage::cli {
namespace {

#if defined(__SSE2__)
constexpr unsigned kFlushAndDenormals = 0x8040;  // MXCSR: FTZ bit 15, DAZ bit 6 (Intel SDM, volume 1, 10.2.3)
unsigned control() { return _mm_getcsr(); }
void set_control(unsigned value) { _mm_setcsr(value); }
constexpr bool kCanFlush = true;
#elif defined(__aarch64__)
constexpr unsigned kFlushAndDenormals = 1U << 24;  // FPCR: FZ (Arm ARM, C5.2.8)
unsigned control() {
  unsigned long value = 0;
  asm volatile("mrs %0, fpcr" : "=r"(value));
  return static_cast<unsigned>(value);
}
void set_control(unsigned value) { asm volatile("msr fpcr, %0" : : "r"(static_cast<unsigned long>(value)) : "memory"); }
constexpr bool kCanFlush = true;
#else
constexpr unsigned kFlushAndDenormals = 0;
unsigned control() { return 0; }
void set_control(unsigned) {}
constexpr bool kCanFlush = false;
#endif

}  // namespace

const std::vector<HostileFp>& hostile_environments() {
  static const std::vector<HostileFp> environments = [] {
    std::vector<HostileFp> all = {
        {"upward", FE_UPWARD, false}, {"downward", FE_DOWNWARD, false}, {"toward zero", FE_TOWARDZERO, false}};
    if (kCanFlush) {
      all.push_back({"flush to zero", FE_TONEAREST, true});
      all.push_back({"upward, flush to zero", FE_UPWARD, true});
    }
    return all;
  }();
  return environments;
}

HostileScope::HostileScope(const HostileFp& hostile) noexcept : rounding_(std::fegetround()), control_(control()) {
  std::fesetround(hostile.rounding);
  if (hostile.flushes) set_control(control() | kFlushAndDenormals);
}

HostileScope::~HostileScope() {
  std::fesetround(rounding_);
  set_control(control_);
}

}  // namespace selvage::cli
