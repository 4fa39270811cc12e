// When a case has taken too long, whatever else the machine does: a loaded machine makes nothing a hang.
#pragma once

#include <chrono>
#include <cstdint>

namespace selvage::fuzz {

/// What the driver sees of a worker when it looks, several times a second.
struct WorkerSight {
  std::int64_t beat = 0;         ///< grows with every case
  double processor_seconds = 0;  ///< used by the process in all
  bool is_asleep = false;        ///< no thread of it wants a processor
  std::chrono::steady_clock::time_point now;
};

class CaseClock {
 public:
  /// Whether the case in hand has had more than `case_seconds`: of processor time, and of time in which it was seen
  /// asleep. Not counted is the time in which it waited for a processor or a disk, or in which nobody looked: then the
  /// driver may have been stopped as well.
  [[nodiscard]] bool is_over(const WorkerSight& sight, double case_seconds);

 private:
  std::int64_t beat_ = -1;
  double processor_seconds_at_beat_ = 0, asleep_s_ = 0;
  std::chrono::steady_clock::time_point last_look_;
};

}  // namespace selvage::fuzz
