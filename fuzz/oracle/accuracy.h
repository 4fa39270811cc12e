// How sharp answers are that break no promise: how early a time of impact is, and how often what stays apart is called
// a collision. An absurd tolerance keeps every promise and shows here.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "fuzz/base/motion_query.h"

namespace selvage::fuzz {

/// Of one case; -1: there is nothing to say.
struct AccuracySample {
  int early_time = -1, early_distance = -1;  ///< bins of Accuracy: of a touch that got a time in time
  int gap = -1;                              ///< class of Accuracy::kGaps: of a case without a touch
  bool alarm = false;
};

/// Sums, as in Counts: any division of the work gives the same. Plain data, in memory that processes share.
struct Accuracy {
  /// Bin 0 holds 0, bin k what is above 2^-k up to 2^(1-k); the first of those what is more, the last what is less.
  static constexpr std::size_t kBins = 64;
  /// Class i: the features never come within 2^kGaps[i] of the query's size, and do within the one before. The last,
  /// without such a bound: they come nearer, or it is not known.
  static constexpr std::array<int, 5> kGaps{-10, -20, -30, -40, -50};

  using Histogram = std::array<std::int64_t, kBins>;
  using ByGap = std::array<std::int64_t, kGaps.size() + 1>;
  Histogram early_time{}, early_distance{};  ///< in parts of the step, and of the query's size
  ByGap apart{}, alarms{};

  void add(const AccuracySample& sample);
  Accuracy& operator+=(const Accuracy& other);
  friend bool operator==(const Accuracy&, const Accuracy&) = default;
};

/// One case in so many is measured, chosen by the case itself. It takes some 27 us where `ccd` takes 4 a case: with one
/// in 16 that did 175,000 a second, with one in 128 it does 247,000, as without.
inline constexpr int kMeasuredOneIn = 128;

/// The bin of Accuracy that holds x.
[[nodiscard]] int bin_of(double x);
/// What `collides`, with this time or none, is worth. `touches`: exactly, not before `toi`. A time is compared with the
/// exact first touch; the distance at that time is rounded; gaps are proved.
[[nodiscard]] AccuracySample measure_accuracy(const MotionQuery& query, bool touches, bool alarm,
                                              std::optional<double> toi);

/// Upper bounds of what a histogram holds, each within a factor of two.
struct Spread {
  std::int64_t count = 0;
  double mean = 0, half = 0, nine_tenths = 0, all_but_a_hundredth = 0, worst = 0;
};
[[nodiscard]] Spread spread_of(const Accuracy::Histogram& histogram);

/// Lines for a report, indented by two blanks; nothing where nothing was measured.
[[nodiscard]] std::string accuracy_text(const Accuracy& accuracy);

}  // namespace selvage::fuzz
