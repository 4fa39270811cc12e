#include "fuzz/oracle/query_oracle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fuzz/oracle/closest_approach.h"

namespace selvage::fuzz {
namespace {

bool weights_are_convex(PairKind kind, const std::array<double, 4>& w) {
  const double slack = 0x1p-40;  // "up to rounding", of a few sums and quotients
  const bool non_negative = std::all_of(w.begin(), w.end(), [](double x) { return x >= 0; });
  if (kind == PairKind::kEe) {
    return non_negative && std::abs(w[0] + w[1] - 1) <= slack && std::abs(w[2] + w[3] - 1) <= slack;
  }
  return non_negative && std::abs(w[0] - 1) <= slack && std::abs(w[1] + w[2] + w[3] - 1) <= slack;
}

bool is_well_formed(const MotionQuery& query, const CcdResult& answer) {
  if (!(answer.toi_lower >= 0 && answer.toi_lower <= 1)) return false;
  if (answer.intervals < 0 || answer.intervals > query.options.max_intervals) return false;
  switch (answer.verdict) {
    case CcdVerdict::kSeparated:
      return answer.cause == CcdCause::kNone && answer.toi_lower == 1;
    case CcdVerdict::kUnresolved:
      return answer.cause != CcdCause::kNone;
    case CcdVerdict::kCollides:
      break;
  }
  const double length = answer.normal.norm();
  return answer.cause != CcdCause::kNone && (answer.cause != CcdCause::kEnd || answer.toi_lower == 1) &&
         answer.gap_bound >= 0 && std::isfinite(answer.gap_bound) && weights_are_convex(query.kind, answer.weights) &&
         (length == 0 || std::abs(length - 1) <= 0x1p-40);
}

/// Largest coordinate distance between a vertex of the first feature and one of the second, at either end.
double spread(const MotionQuery& query) {
  double largest = 0;
  const bool edges = query.kind == PairKind::kEe;
  for (const auto* x : {&query.x_t0, &query.x_t1}) {
    for (std::size_t i = 0; i < (edges ? 2U : 1U); ++i) {
      for (std::size_t j = edges ? 2 : 1; j < static_cast<std::size_t>(point_count(query.kind)); ++j) {
        largest = std::max(largest, ((*x)[i] - (*x)[j]).cwiseAbs().maxCoeff());
      }
    }
  }
  return largest;
}

Disagreement check_alarm(const MotionQuery& query, const CcdResult& answer, Judgement& judgement) {
  if (answer.gap_bound > gap_allowance(query, answer.cause)) return Disagreement::kGapTooLoose;
  if (judgement.touches) return Disagreement::kNone;  // distance 0 is within any bound
  if (judgement.hit && answer.gap_bound >= query.options.tolerance) return Disagreement::kNone;  // within it at the end
  const double size = spread(query);  // beyond the domain infinite, which has no exponent
  if (answer.cause == CcdCause::kMotion && answer.gap_bound > 0 && size > 0 && std::isfinite(size)) {
    judgement.near_miss_bits = std::ilogb(size) - std::ilogb(answer.gap_bound);
  }
  const std::array<double, 3> hints{answer.cause == CcdCause::kEnd ? 1 : answer.toi_lower, answer.toi_lower + 0x1p-52,
                                    1};
  switch (closest_approach(query, answer.gap_bound, hints, kEnoughTests)) {
    case Approach::kBeyond:
      return Disagreement::kFalseAlarmTooFar;
    case Approach::kUnknown:
      judgement.gap_unknown = true;
      break;
    case Approach::kWithin:
      break;
  }
  return Disagreement::kNone;
}

Disagreement compare(const MotionQuery& query, const CcdResult& answer, int first_touch_order, Judgement& judgement) {
  const bool free_of_touch = answer.verdict == CcdVerdict::kSeparated || answer.cause == CcdCause::kEnd;
  if (judgement.touches && free_of_touch) return Disagreement::kMissed;
  if (judgement.hit && answer.verdict == CcdVerdict::kSeparated) return Disagreement::kEndMissed;
  if (judgement.touches && answer.toi_lower > 0 && first_touch_order < 0) return Disagreement::kLateToi;
  return answer.verdict == CcdVerdict::kCollides ? check_alarm(query, answer, judgement) : Disagreement::kNone;
}

}  // namespace

std::string_view name_of(Disagreement disagreement) {
  switch (disagreement) {
    case Disagreement::kNone:
      return "none";
    case Disagreement::kMissed:
      return "missed";
    case Disagreement::kEndMissed:
      return "end-missed";
    case Disagreement::kLateToi:
      return "late-toi";
    case Disagreement::kFalseAlarmTooFar:
      return "false-alarm-too-far";
    case Disagreement::kGapTooLoose:
      return "gap-too-loose";
    case Disagreement::kMalformed:
      break;
  }
  return "malformed";
}

double gap_allowance(const MotionQuery& query, CcdCause cause) {
  // Motion: 2^-40 of the largest distance is the kernel's own limit for an alarm (kAlarmGap; twice it, since it scales
  // by the next power of two). What it needs is far less: campaigns see 64 roundings exceeded in 1 case of 10,000.
  // End: the distance has a bracket; proximity_oracle.cpp says how wide it gets for ill-conditioned pairs.
  const double size = spread(query);
  const double rounded_out = 8 * std::numeric_limits<double>::denorm_min();
  if (cause == CcdCause::kEnd) {
    return query.options.tolerance * (1 + 0x1p-40) + std::max(0x1p-24 * size, rounded_out);
  }
  return std::max(0x1p-39 * size, rounded_out);
}

Judgement judge(const MotionQuery& query, const CcdResult& answer) {
  Judgement judgement;
  const bool well_formed = is_well_formed(query, answer);
  const verify::MotionAgainst exact = motion_against(query, well_formed ? answer.toi_lower : 0);
  judgement.touches = exact.touches;
  judgement.exact_used = exact.exact_used;
  // What does not touch at all is not within 0 at the end.
  judgement.hit = judgement.touches || (query.options.tolerance > 0 && within_at(query, 1, query.options.tolerance));
  judgement.disagreement = well_formed ? compare(query, answer, exact.order, judgement) : Disagreement::kMalformed;
  return judgement;
}

}  // namespace selvage::fuzz
