#include "kernel/query/ccd_search.h"

#include "kernel/assert.h"
#include "kernel/query/ccd_answer.h"
#include "kernel/query/ccd_precise.h"
#include "kernel/query/closest_point.h"
#include "kernel/query/coplanarity.h"
#include "kernel/query/plane_passage.h"
#include "kernel/query/root_intervals.h"
#include "kernel/query/separation.h"

namespace selvage::detail {

namespace {

/// A gap below this is of the order of the rounding of its own evaluation: halving the interval further is no use.
constexpr double kNoGap = 0x1p-49;
/// Within intervals no wider than this many ticks corners hardly move, and Gilbert's algorithm finds no better
/// direction.
constexpr Tick kStillWidth = Tick{1} << 32;
/// Intervals that plain doubles may take to clear one interval of roots: from the whole step down to a tick takes 52,
/// and as many again for the other halves. Where features close in tangentially, doubles then go on inch by inch.
constexpr int kMaxDoubleIntervals = 128;
/// Pieces that may wait while another is split at its root. A root that is found badly leaves a piece with a sign
/// change behind, again and again; from here on pieces are halved, at most 52 times down to a tick, so that 128 places
/// are enough.
constexpr std::size_t kSplitDepth = 64;
/// A contact with weights above this lies inside both features, so that a sign change of the cubic makes it a real one.
constexpr double kInnerWeight = 0x1p-20;

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
  [[nodiscard]] Polygon polygon(Tick tick) const { return polygon_at_tick(motion_, tick); }
  [[nodiscard]] bool limit_reached() const { return result_.intervals >= options_.max_intervals; }

  /// Records a contact at this time; false, which is what clear() returns then.
  bool answer(Tick contact);
  bool clear(const TickInterval& interval);
  bool certify(const TickInterval& interval, const Polygon& at_begin, const Polygon& at_end);
  void look_precisely();
  [[nodiscard]] CubicSigns cubic_signs(const TickInterval& interval) const;
  bool clear_precisely(const TickInterval& interval, double suspect);
  [[nodiscard]] bool is_contact(Tick tick, const Polygon& at, const ClosestPoint<double>& closest,
                                const CubicSigns& signs) const;

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
  if (interval.end - interval.begin <= kStillWidth) return false;
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

/// With double-double arithmetic; `suspect` is a time worth looking at first, as a fraction of the interval.
bool Search::clear_precisely(const TickInterval& interval, double suspect) {
  look_precisely();
  std::int32_t left = options_.max_intervals - result_.intervals;
  const auto contact = first_precise_contact(*precise_motion_, interval, suspect, left);
  result_.intervals = options_.max_intervals - left;
  if (!contact) return true;
  return answer(*contact);
}

/// Whether the features are in contact at the begin of an interval with these signs, as far as doubles can tell.
bool Search::is_contact(Tick tick, const Polygon& at, const ClosestPoint<double>& closest,
                        const CubicSigns& signs) const {
  const auto& w = closest.weights;
  const double least_weight = std::min(std::min(w[0], w[1]), std::min(w[2], w[3]));
  return (signs.root && least_weight > kInnerWeight) || gap_upper(motion_, tick, at, w) == 0;
}

bool Search::answer(Tick contact) {
  answer_contact(result_, motion_, contact);
  return false;
}

/// Depth first, from left to right: everything before `begin` is certified at all times.
bool Search::clear(const TickInterval& interval) {
  std::array<Tick, 128> ends;
  std::size_t depth = 1;
  ends[0] = interval.end;
  Tick begin = interval.begin;
  Polygon at_begin = polygon(begin);
  int examined = 0;
  while (depth > 0) {
    if (limit_reached()) return answer(begin);
    ++result_.intervals;
    if (++examined > kMaxDoubleIntervals) return clear_precisely({begin, interval.end}, 0);
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
    const auto reach = separated_reach(motion_, at_begin, at_end, closest);
    const auto reached = static_cast<Tick>(reach.share * static_cast<double>(width));
    if (reach.share > kFarShare && reached > 0 && reached < width) {
      const Polygon at_reached = polygon(begin + reached);
      if (separates(motion_, at_begin, at_reached, reach.direction)) {
        separating_ = reach.direction;
        begin += reached;
        at_begin = at_reached;
        continue;
      }
    }
    if (!precise_motion_) {
      look_precisely();
      continue;
    }
    SELVAGE_ASSERT(depth + 2 <= ends.size());
    const bool is_apart = reach.share > 0 && gap_upper(motion_, begin, at_begin, closest.weights) > kNoGap;
    if (signs.root && width > kNarrowWidth && depth < kSplitDepth) {
      // The tick of the root and its neighbours: the pieces beside these are then free of roots.
      const Tick at_root = begin + static_cast<Tick>(*signs.root * static_cast<double>(width));
      if (at_root + 2 < piece.end) ends[depth++] = at_root + 2;
      if (at_root > begin + 1) ends[depth++] = at_root - 1;
    } else if (signs.root ? width > kNarrowWidth : width > 1 && (signs.nonzero_begin || is_apart)) {
      ends[depth++] = begin + width / 2;
    } else if (is_contact(begin, at_begin, closest, signs)) {
      return answer(begin);
    } else {
      if (!clear_precisely(piece, signs.root.value_or(0))) return false;
      begin = piece.end;
      at_begin = at_end;
      --depth;
    }
  }
  return true;
}

CcdResult Search::run() {
  RootIntervals pieces;
  pieces.interval[0] = {0, kTicks};
  pieces.count = 1;
  if (has_cubic()) {
    const PlanePassage plain = plane_passage(motion_);
    result_.intervals = std::min(plain.intervals, options_.max_intervals);
    if (plain.intervals > options_.max_intervals) {
      answer(0);
      return result_;
    }
    if (plain.passage == Passage::kContact) return contact_answer(plain, motion_.exponent);
    if (plain.passage == Passage::kSeparated) {
      answer_end(result_, motion_, options_.tolerance);
      return result_;
    }
    cubic_ = coplanarity_cubic(motion_);
    pieces = root_intervals(cubic_, options_.max_intervals - result_.intervals);
  }
  result_.intervals += pieces.examined;
  for (int i = 0; i < pieces.count; ++i) {
    if (!clear(pieces.interval[static_cast<std::size_t>(i)])) return result_;
  }
  answer_end(result_, motion_, options_.tolerance);
  return result_;
}

}  // namespace

CcdResult search_in_time(PairKind kind, const PairPoints& x_t0, const PairPoints& x_t1, const CcdOptions& options) {
  return Search(kind, x_t0, x_t1, options).run();
}

}  // namespace selvage::detail
