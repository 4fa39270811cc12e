// What the benchmarks share: the clock, quantiles, and the error of a time of impact.
#pragma once

#include <cstddef>
#include <cstdint>
#include <ctime>
#include <vector>

namespace selvage::bench {

/// Processor time of this thread: what other programs take from a shared machine does not count.
inline double thread_nanoseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e9 + static_cast<double>(now.tv_nsec);
}

/// The same of all threads together.
inline double process_nanoseconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e9 + static_cast<double>(now.tv_nsec);
}

/// Of sorted values: the smallest that at least this share of them does not exceed; 0 of none.
inline double quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0;
  const auto rank = static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1) + 0.5);
  return sorted[rank];
}

/// Time of impact against the exact first touch, as fractions of the step, over the contacts that were found.
struct ToiError {
  std::int64_t late = 0;  ///< answers later than the exact first touch, decided exactly
  double late_max = 0;
  double early_median = 0, early_p99 = 0, early_max = 0;
};

}  // namespace selvage::bench
