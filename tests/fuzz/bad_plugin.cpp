// A plugin that says "collides" to everything and does one thing that nobody may do, chosen by a macro.
#include <csignal>

#include <xmmintrin.h>

#include "fuzz/selvage-plugin.h"

namespace {

[[maybe_unused]] constexpr unsigned kFlushToZero = 0x8000, kRoundUp = 0x4000;  // MXCSR

void answer(int32_t /*kind*/, [[maybe_unused]] const selvage_query* query, selvage_answer* answer) {
  answer->verdict = SELVAGE_COLLIDES;
#if defined(HANGS)
  volatile bool goes_on = true;
  while (goes_on) {
  }
#elif defined(CRASHES)
  std::raise(SIGSEGV);
#elif defined(WRITES_OUT_OF_BOUNDS)
  answer[1].verdict = 0;
#elif defined(GIVES_NO_VERDICT)
  answer->verdict = 17;
#elif defined(CHANGES_ROUNDING)
  _mm_setcsr(_mm_getcsr() | kRoundUp);
#elif defined(SETS_FTZ)
  _mm_setcsr(_mm_getcsr() | kFlushToZero);
#endif
}

}  // namespace

extern "C" const selvage_plugin* selvage_plugin_entry(void) {
  static const selvage_plugin plugin = {SELVAGE_PLUGIN_VERSION, "bad", 0x1p+1000, 0, 0, answer, nullptr};
  return &plugin;
}
