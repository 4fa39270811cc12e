#include "cli/process/hostile_fp.h"

namespace selvage::cli {
namespace {

// <cfenv> has no word for the flushing of subnormal numbers: where glibc keeps the register that says so, and which
// bits. (The checker compiles for these two processors alone.)
#if defined(__x86_64__)
constexpr auto kControl = &std::fenv_t::__mxcsr;
constexpr unsigned kFlushing = 0x8040;  // FTZ bit 15, DAZ bit 6 (Intel SDM, volume 1, 10.2.3)
#else
constexpr auto kControl = &std::fenv_t::__fpcr;
constexpr unsigned kFlushing = 1U << 24;  // FZ (Arm ARM, C5.2.8)
#endif

}  // namespace

const std::vector<HostileFp>& hostile_environments() {
  static const std::vector<HostileFp> environments = {{"upward", FE_UPWARD, false},
                                                      {"downward", FE_DOWNWARD, false},
                                                      {"toward zero", FE_TOWARDZERO, false},
                                                      {"flush to zero", FE_TONEAREST, true},
                                                      {"upward, flush to zero", FE_UPWARD, true}};
  return environments;
}

HostileScope::HostileScope(const HostileFp& hostile) noexcept {
  std::fegetenv(&found_);
  std::fenv_t set = found_;
  if (hostile.flushes) set.*kControl |= kFlushing;
  std::fesetenv(&set);
  std::fesetround(hostile.rounding);
}

HostileScope::~HostileScope() { std::fesetenv(&found_); }

}  // namespace selvage::cli
