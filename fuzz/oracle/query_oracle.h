// The judge of the query level: a kernel's answer against exact arithmetic. One function sees both answers.
#pragma once

#include <cstdint>
#include <string_view>

#include "fuzz/base/motion_query.h"

namespace selvage::fuzz {

enum class Disagreement : std::uint8_t {
  kNone,
  kMissed,            ///< K1: `separated`, or free of touch with cause kEnd, and yet the features touch
  kEndMissed,         ///< K1: `separated`, and yet within tolerance at t = 1
  kLateToi,           ///< K2: the features touch before toi_lower
  kFalseAlarmTooFar,  ///< K3: `collides`, and the features never come within gap_bound
  kGapTooLoose,       ///< K3: gap_bound is above gap_allowance(): a bound that bounds nothing
  kMalformed,         ///< a field is not a number, out of its range, or contradicts another
};
[[nodiscard]] std::string_view name_of(Disagreement disagreement);

struct Judgement {
  Disagreement disagreement = Disagreement::kNone;
  bool touches = false;      ///< exactly, at some t in [0,1]
  bool hit = false;          ///< touches, or ends within tolerance: must not be answered `separated`
  bool gap_unknown = false;  ///< an alarm whose closest approach closest_approach() could not decide
  bool exact_used = false;   ///< the checker's filter did not decide whether they touch
  /// Where an alarm by motion does not touch: how near to a touch the query is, as bits of size / gap_bound; else 0.
  int near_miss_bits = 0;
};

/// Everything that promises K1 to K3 say about `answer`. `unresolved` claims its toi_lower and no more.
[[nodiscard]] Judgement judge(const MotionQuery& query, const CcdResult& answer);

/// The largest gap_bound that is still worth something: the tolerance where the end is close, and otherwise a small
/// multiple of the roundoff of the largest distance between corners of the two features, which no method that works on
/// doubles can avoid. Without it "collides, gap_bound = infinity" would keep promise K3.
[[nodiscard]] double gap_allowance(const MotionQuery& query, CcdCause cause);

}  // namespace selvage::fuzz
