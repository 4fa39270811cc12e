#include "fuzz/run/case_clock.h"

#include <algorithm>

namespace selvage::fuzz {
namespace {

/// Twice what the driver waits between two looks. A longer gap says that the driver itself was not running.
constexpr double kLongestLook_s = 0.2;

}  // namespace

bool CaseClock::is_over(const WorkerSight& sight, double case_seconds) {
  if (sight.beat != beat_) {
    beat_ = sight.beat;
    processor_seconds_at_beat_ = sight.processor_seconds;
    asleep_s_ = 0;
  } else if (sight.is_asleep) {
    asleep_s_ += std::min(std::chrono::duration<double>(sight.now - last_look_).count(), kLongestLook_s);
  }
  last_look_ = sight.now;
  return sight.processor_seconds - processor_seconds_at_beat_ + asleep_s_ > case_seconds;
}

}  // namespace selvage::fuzz
