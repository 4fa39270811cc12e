// The error of times of impact: how many are late, and how early the others are.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "bench/measure.h"

namespace selvage::bench {

/// Time of impact against the exact first touch, as fractions of the step, over the contacts that were found.
struct ToiError {
  std::int64_t late = 0;  ///< answers later than the exact first touch, decided exactly
  double late_max = 0;
  double early_median = 0, early_p99 = 0, early_max = 0;
};

/// Collects the answers of one method.
class ToiErrors {
 public:
  /// `first` is the exact first touch rounded down, which alone does not tell whether the answer `toi` is late.
  void add(double first, double toi, bool is_late) {
    early_.push_back(std::max(0.0, first - toi));
    if (!is_late) return;
    ++late_;
    late_max_ = std::max(late_max_, toi - first);
  }

  [[nodiscard]] std::int64_t count() const { return static_cast<std::int64_t>(early_.size()); }

  [[nodiscard]] ToiError summary() const {
    std::vector<double> early = early_;
    std::sort(early.begin(), early.end());
    return {late_, late_max_, quantile(early, 0.5), quantile(early, 0.99), early.empty() ? 0 : early.back()};
  }

 private:
  std::int64_t late_ = 0;
  double late_max_ = 0;
  std::vector<double> early_;  // of all answers, 0 of those that are not
};

}  // namespace selvage::bench
