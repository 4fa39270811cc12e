#include "kernel/ccd_search.h"

#include "kernel/assert.h"
#include "kernel/closest_point.h"
#include "kernel/coplanarity.h"
#include "kernel/plane_crossing.h"
#include "kernel/power_of_two.h"
#include "kernel/root_intervals.h"
#include "kernel/rounding.h"
#include "kernel/separation.h"

namespace selvage::detail {

namespace {

/// An alarm is raised only with a witness this near, relative to the largest difference (in [0.5, 1) after scaling).
/// One tick is left uncertified only if the gap in it is of the order of the rounding of one support, 3 kSupportError,
/// plus the motion within one tick, 2^-51: below 2^-48. The rest is room for directions that are not optimal.
constexpr double kAlarmGap = 0x1p-40;
/// A gap below this is of the order of the rounding of its own evaluation: halving the interval further is no use.
constexpr double kNoGap = 0x1p-49;
/// Intervals no wider than this many ticks are worth the cubic in double-double arithmetic.
constexpr Tick kPreciseWidth = Tick{1} << 32;
/// Pieces that may wait while another is split at its root or where a direction ceases to separate. A split that is
/// found badly leaves nearly all behind, again and again; from here on pieces are halved, at most 52 times down to a
/// tick, so that 128 places are enough.
constexpr std::size_t kSplitDepth = 64;
/// A direction that separates a smaller share of an interval than this does not make better progress than halving.
constexpr double kFarShare = 0.125;
/// A contact with weights above this lies inside both features, so that a sign change of the cubic makes it a real one.
constexpr double kInnerWeight = 0x1p-20;
/// So does one this deep inside the polygon, if the interval is short: the polygon's height is at least this, so that
/// its frame is well-conditioned, depth is good to 2^-50, and nothing moves farther than 2^-33 within the interval.
constexpr double kInnerDepth = 0x1p-20;
/// Within so many ticks plain doubles may place a contact: toi_lower is early by at most 2^-36 of the step. The root
/// intervals of 99.9 % of the contacts of a public cloth frame are below 2^12 ticks, half of them below 2^7.
constexpr Tick kShortWidth = Tick{1} << 16;

/// How the origin passes the plane of the difference polygon within a short interval.
enum class Passage : std::uint8_t {
  kBeside,   ///< PROVED: no touch
  kThrough,  ///< within kAlarmGap of a touch, and through the inside of the polygon
  kUnclear,
};

/// What the cubic in double-double arithmetic says of an interval; nothing where there is none.
struct CubicSigns {
  bool definite = false;       ///< PROVED: no root in the interval
  bool nonzero_begin = false;  ///< PROVED: no root at its begin
  std::optional<double> root;  ///< where it passes from one sign to the other, as a fraction of the interval
};

class Search {
 public:
  Search(PairKind kind, const PairPoints& x_t0, const PairPoints& x_t1, const CcdOptions& options)
      : x_t0_(x_t0), x_t1_(x_t1), options_(options), motion_(make_pair_motion<double>(kind, x_t0, x_t1)) {}

  CcdResult run();

 private:
  using Polygon = DifferencePolygon<double>;

  [[nodiscard]] bool has_cubic() const { return motion_.kind != PairKind::kSelf; }
  [[nodiscard]] Polygon polygon(Tick tick) const;
  [[nodiscard]] double gap_upper(Tick tick, const Polygon& at, const ClosestPoint<double>& closest) const;
  [[nodiscard]] bool limit_reached() const { return result_.intervals >= options_.max_intervals; }

  Passage pass_plane(const TickInterval& interval);
  bool clear(const TickInterval& interval);
  bool certify(const TickInterval& interval, const Polygon& at_begin, const Polygon& at_end);
  void look_precisely();
  [[nodiscard]] CubicSigns cubic_signs(const TickInterval& interval) const;
  std::optional<Tick> first_contact(const TickInterval& interval, const Polygon& at_begin, const CubicSigns& signs);
  void answer_contact(Tick tick);
  void answer(Tick tick, double gap, const std::array<double, 4>& weights, const Double3& direction);
  void answer_end();
  Double3 approach_normal(Tick tick) const;

  const PairPoints& x_t0_;
  const PairPoints& x_t1_;
  const CcdOptions& options_;
  const PairMotion<double> motion_;
  CoplanarityCubic<double> cubic_;                          // where there is one
  std::optional<PairMotion<DoubleDouble>> precise_motion_;  // both made when first needed
  std::optional<CoplanarityCubic<DoubleDouble>> precise_cubic_;
  Double3 separating_;  // the last direction that certified an interval: the next one often is like it
  CcdResult result_;
};

Search::Polygon Search::polygon(Tick tick) const {
  if (tick == 0) return motion_.t0;
  if (tick == kTicks) return motion_.t1;
  return polygon_at(motion_, time_of(kTicks - tick), time_of(tick));
}

double Search::gap_upper(Tick tick, const Polygon& at, const ClosestPoint<double>& closest) const {
  return distance_upper(motion_, at, tick != 0 && tick != kTicks, closest.weights);
}

/// Plain doubles on a short interval, at the end of which the cubic has passed through zero. Everything before the
/// interval is certified, so that its begin is a safe time.
Passage Search::pass_plane(const TickInterval& interval) {
  if (interval.end - interval.begin > kShortWidth || limit_reached()) return Passage::kUnclear;
  ++result_.intervals;
  const Polygon at_begin = polygon(interval.begin);
  const PlaneCrossing crossing = plane_crossing(motion_.kind, at_begin);
  if (crossing.depth < 0) {
    const bool beside = separates(motion_, at_begin, polygon(interval.end), crossing.outward);
    return beside ? Passage::kBeside : Passage::kUnclear;
  }
  const double before = value_at(cubic_, time_of(interval.begin)), after = value_at(cubic_, time_of(interval.end));
  const double bound = cubic_.error_bound;
  const bool falls = before > bound && after < -bound, rises = before < -bound && after > bound;
  if (!(falls || rises) || !(crossing.depth > kInnerDepth)) return Passage::kUnclear;
  const double gap = distance_upper(motion_, at_begin, true, crossing.weights);
  if (!(gap <= kAlarmGap)) return Passage::kUnclear;
  // The cubic is 3 normal . corner: its sign is the side of the polygon on which the origin is not.
  answer(interval.begin, gap, crossing.weights, falls ? crossing.normal : -crossing.normal);
  return Passage::kThrough;
}

bool Search::certify(const TickInterval& interval, const Polygon& at_begin, const Polygon& at_end) {
  if (!is_zero(separating_) && separates(motion_, at_begin, at_end, separating_)) return true;
  const Tick middle = interval.begin + (interval.end - interval.begin) / 2;
  const auto closest = closest_point(motion_.kind, polygon(middle));
  for (const Double3& n : {closest.direction, closest.plane_normal}) {
    if (separates(motion_, at_begin, at_end, n)) {
      separating_ = n;
      return true;
    }
  }
  if (winds_apart(motion_, at_begin, at_end)) return true;
  // In a short interval the corners hardly move, and the directions above are the best there are.
  if (interval.end - interval.begin <= kPreciseWidth) return false;
  const auto direction = separating_direction(motion_, at_begin, at_end, closest.point);
  if (direction) separating_ = *direction;
  return direction.has_value();
}

void Search::look_precisely() {
  if (precise_motion_) return;
  precise_motion_ = make_pair_motion<DoubleDouble>(motion_.kind, x_t0_, x_t1_);
  if (!has_cubic()) return;
  const auto cubic = coplanarity_cubic(*precise_motion_);
  double largest = 0;
  for (const DoubleDouble& c : cubic.coefficient) largest = std::max(largest, std::fabs(leading(c)));
  if (largest > cubic.error_bound) precise_cubic_ = cubic;
}

CubicSigns Search::cubic_signs(const TickInterval& interval) const {
  CubicSigns signs;
  if (!precise_cubic_) return signs;
  const auto local = local_coefficients(*precise_cubic_, interval);
  const std::array<double, 4> c = {leading(local[0]), leading(local[1]), leading(local[2]), leading(local[3])};
  const double bound = precise_cubic_->error_bound;
  const auto [least, greatest] = std::minmax({c[0], c[1], c[2], c[3]});
  signs.definite = least > bound || greatest < -bound;
  signs.nonzero_begin = std::fabs(c[0]) > bound;
  if ((c[0] > bound && c[3] < -bound) || (c[0] < -bound && c[3] > bound)) signs.root = root_fraction(c, 0);
  return signs;
}

/// The first tick of the interval that cannot be proved free of touch by any means; nothing where it is free.
std::optional<Tick> Search::first_contact(const TickInterval& interval, const Polygon& at_begin,
                                          const CubicSigns& signs) {
  const auto closest = closest_point(motion_.kind, at_begin);
  if (gap_upper(interval.begin, at_begin, closest) == 0) return interval.begin;
  const auto& w = closest.weights;
  const double least_weight = std::min(std::min(w[0], w[1]), std::min(w[2], w[3]));
  if (signs.root && least_weight > kInnerWeight) return interval.begin;
  look_precisely();
  std::int32_t left = options_.max_intervals - result_.intervals;
  const auto contact = first_precise_contact(*precise_motion_, interval, signs.root.value_or(0), left);
  result_.intervals = options_.max_intervals - left;
  return contact;
}

/// Depth first, from left to right: everything before `begin` is certified at all times.
bool Search::clear(const TickInterval& interval) {
  std::array<Tick, 128> ends;
  std::size_t depth = 1;
  ends[0] = interval.end;
  Tick begin = interval.begin;
  Polygon at_begin = polygon(begin);
  while (depth > 0) {
    if (limit_reached()) {
      result_.toi_lower = time_of(begin);
      return false;
    }
    ++result_.intervals;
    const TickInterval piece = {begin, ends[depth - 1]};
    const Tick width = piece.end - piece.begin;
    const Polygon at_end = polygon(piece.end);
    const CubicSigns signs = cubic_signs(piece);
    if (signs.definite || certify(piece, at_begin, at_end)) {
      begin = piece.end;
      at_begin = at_end;
      --depth;
      continue;
    }
    const auto closest = closest_point(motion_.kind, at_begin);
    const double share = separated_share(motion_, at_begin, at_end, closest.direction);
    const bool makes_way = share > kFarShare && width > 1 && depth < kSplitDepth;
    if (!makes_way && !precise_motion_) {
      look_precisely();
      continue;
    }
    SELVAGE_ASSERT(depth + 2 <= ends.size());
    if (signs.root && width > kNarrowWidth && depth < kSplitDepth) {
      // The tick of the root and its neighbours: the pieces beside these are then free of roots.
      const Tick at_root = begin + static_cast<Tick>(*signs.root * static_cast<double>(width));
      if (at_root + 2 < piece.end) ends[depth++] = at_root + 2;
      if (at_root > begin + 1) ends[depth++] = at_root - 1;
    } else if (makes_way && !signs.root) {
      separating_ = closest.direction;
      ends[depth++] = begin + std::clamp(static_cast<Tick>(share * static_cast<double>(width)), Tick{1}, width - 1);
    } else if (signs.root ? width > kNarrowWidth
                          : width > 1 && (signs.nonzero_begin || gap_upper(begin, at_begin, closest) > kNoGap)) {
      ends[depth++] = begin + width / 2;
    } else if (const auto tick = first_contact(piece, at_begin, signs)) {
      answer_contact(*tick);
      return false;
    } else {
      begin = piece.end;
      at_begin = at_end;
      --depth;
    }
  }
  return true;
}

/// The direction a little before `tick`, where the gap is wide enough that its bracket shows it to be good.
Double3 Search::approach_normal(Tick tick) const {
  constexpr double kGoodBracket = 1 - 0x1p-20;  // sin(angle) <= sqrt(1 - kGoodBracket^2) = 2^-9.5
  for (const int back : {24, 36, 48, 52}) {
    const Tick earlier = tick > (Tick{1} << back) ? tick - (Tick{1} << back) : 0;
    const Polygon at = polygon(earlier);
    const auto closest = closest_point(motion_.kind, at);
    const double lower = distance_lower(motion_, at, closest);
    if (earlier == 0 || lower > kGoodBracket * gap_upper(earlier, at, closest)) return closest.direction;
  }
  return {};
}

void Search::answer_contact(Tick tick) {
  const Polygon at = polygon(tick);
  const auto closest = closest_point(motion_.kind, at);
  answer(tick, gap_upper(tick, at, closest), closest.weights, approach_normal(tick));
}

void Search::answer(Tick tick, double gap, const std::array<double, 4>& weights, const Double3& direction) {
  result_.verdict = gap <= kAlarmGap ? CcdVerdict::kCollides : CcdVerdict::kUnresolved;
  result_.cause = CcdCause::kMotion;
  result_.toi_lower = time_of(tick);
  result_.gap_bound = times_power_upper(gap, motion_.exponent);
  result_.weights = weights;
  if (!is_zero(direction)) result_.normal = to_vec3(scaled(1 / norm(direction), direction));
}

void Search::answer_end() {
  result_.toi_lower = 1;
  result_.cause = CcdCause::kNone;
  result_.verdict = CcdVerdict::kSeparated;
  if (options_.tolerance == 0) return;  // no touch at t = 1 is a distance above zero
  const auto closest = closest_point(motion_.kind, motion_.t1);
  const double lower = distance_lower(motion_, motion_.t1, closest);
  if (times_power_lower(lower, motion_.exponent) > options_.tolerance) return;
  result_.verdict = CcdVerdict::kCollides;
  result_.cause = CcdCause::kEnd;
  result_.gap_bound = times_power_upper(gap_upper(kTicks, motion_.t1, closest), motion_.exponent);
  result_.weights = closest.weights;
  if (!is_zero(closest.direction)) {
    result_.normal = to_vec3(scaled(1 / norm(closest.direction), closest.direction));
  }
}

CcdResult Search::run() {
  if (limit_reached()) return result_;
  RootIntervals pieces;
  pieces.interval[0] = {0, kTicks};
  pieces.count = 1;
  if (has_cubic()) {
    cubic_ = coplanarity_cubic(motion_);
    pieces = root_intervals(cubic_, options_.max_intervals);
  }
  result_.intervals += pieces.examined;
  for (int i = 0; i < pieces.count; ++i) {
    const TickInterval& piece = pieces.interval[static_cast<std::size_t>(i)];
    const Passage passage = has_cubic() ? pass_plane(piece) : Passage::kUnclear;
    if (passage == Passage::kThrough || (passage == Passage::kUnclear && !clear(piece))) return result_;
  }
  answer_end();
  return result_;
}

}  // namespace

CcdResult search_in_time(PairKind kind, const PairPoints& x_t0, const PairPoints& x_t1, const CcdOptions& options) {
  return Search(kind, x_t0, x_t1, options).run();
}

}  // namespace selvage::detail
