// The search in time: intervals from left to right, each certified free of touch or halved.
#include <bit>
#include <limits>

#include "kernel/canonical_order.h"
#include "kernel/ccd_detail.h"
#include "kernel/closest_point.h"
#include "kernel/coplanarity.h"
#include "kernel/rounding.h"

namespace selvage::detail {

namespace {

/// Times are counted in ticks of 2^-52, so that t and 1 - t are both exact doubles.
constexpr std::uint64_t kTicks = std::uint64_t{1} << 52;
double time_of(std::uint64_t tick) { return static_cast<double>(tick) * 0x1p-52; }

/// An alarm is raised only with a witness this near, relative to the largest difference (in [0.5, 1) after scaling).
/// An interval of one tick is left uncertified only if the gap in it is of the order of the rounding of one support,
/// kSupportError * 3, plus the motion in one tick, 2^-51: below 2^-48. The rest is room for directions that are not
/// optimal, at needles above all.
constexpr double kAlarmGap = 0x1p-40;

/// Steps of Gilbert's algorithm on the swept corners; the cloth negatives that need them end within four.
constexpr int kGilbertSteps = 6;

class Search {
 public:
  Search(const PairMotion& motion, const CcdOptions& options) : motion_(motion), options_(options) {
    if (motion.kind != PairKind::kSelf) cubic_ = coplanarity_cubic(motion);
  }

  CcdResult run();

 private:
  bool certify(std::uint64_t begin, std::uint64_t end, const DifferencePolygon& at_begin,
               const DifferencePolygon& at_end);
  bool separates(const Double3& n, const DifferencePolygon& at_begin, const DifferencePolygon& at_end);
  bool refine_direction(Double3 point, const DifferencePolygon& at_begin, const DifferencePolygon& at_end);
  void answer_contact(std::uint64_t begin, std::uint64_t end, const DifferencePolygon& at_begin,
                      const DifferencePolygon& at_end);
  void answer_end();
  double gap_at(std::uint64_t tick, const DifferencePolygon& polygon, const ClosestPoint& closest) const;

  const PairMotion& motion_;
  const CcdOptions& options_;
  CoplanarityCubic cubic_;
  Double3 separating_;  // the last direction that certified an interval
  CcdResult result_;
};

bool Search::separates(const Double3& n, const DifferencePolygon& at_begin, const DifferencePolygon& at_end) {
  const double support =
      std::min(least_support(motion_.corner_count, at_begin, n), least_support(motion_.corner_count, at_end, n));
  if (!(support > support_error(n, motion_.extent))) return false;
  separating_ = n;
  return true;
}

/// Gilbert's algorithm (1966): walks toward the point of the swept hull nearest to the origin, which is the best
/// direction there is.
bool Search::refine_direction(Double3 point, const DifferencePolygon& at_begin, const DifferencePolygon& at_end) {
  for (int step = 0; step < kGilbertSteps; ++step) {
    const Double3 n = normalize_exponent(point);
    if (is_zero(n)) return false;
    const Double3* support = nullptr;
    double least = std::numeric_limits<double>::infinity();
    for (const DifferencePolygon* polygon : {&at_begin, &at_end}) {
      for (int i = 0; i < motion_.corner_count; ++i) {
        const Double3& corner = polygon->corner[static_cast<std::size_t>(i)];
        const double value = dot(n, corner);
        if (value < least) {
          least = value;
          support = &corner;
        }
      }
    }
    if (least > support_error(n, motion_.extent)) {
      separating_ = n;
      return true;
    }
    if (support == nullptr) return false;
    const Double3 toward = *support - point;
    const double fraction = -dot(point, toward) / dot(toward, toward);
    if (!(fraction > 0)) return false;
    point = point + std::min(fraction, 1.0) * toward;
  }
  return false;
}

bool Search::certify(std::uint64_t begin, std::uint64_t end, const DifferencePolygon& at_begin,
                     const DifferencePolygon& at_end) {
  if (!is_zero(separating_) && separates(separating_, at_begin, at_end)) return true;
  const DifferencePolygon middle = polygon_at(motion_, time_of(begin + (end - begin) / 2));
  const ClosestPoint closest = closest_point(motion_.kind, middle);
  if (!is_zero(closest.direction) && separates(closest.direction, at_begin, at_end)) return true;
  if (motion_.kind != PairKind::kSelf && is_definite(cubic_, time_of(begin), time_of(end))) {
    if (!is_zero(closest.direction)) separating_ = closest.direction;
    return true;
  }
  return refine_direction(closest.point, at_begin, at_end);
}

double Search::gap_at(std::uint64_t tick, const DifferencePolygon& polygon, const ClosestPoint& closest) const {
  const Double3 blend_extent = tick == 0 || tick == kTicks ? Double3{} : motion_.extent;
  return distance_upper(motion_.kind, polygon, blend_extent, motion_.exact_scaling, closest.weights);
}

void Search::answer_contact(std::uint64_t begin, std::uint64_t end, const DifferencePolygon& at_begin,
                            const DifferencePolygon& at_end) {
  const ClosestPoint first = closest_point(motion_.kind, at_begin);
  const ClosestPoint last = closest_point(motion_.kind, at_end);
  const double first_gap = gap_at(begin, at_begin, first), last_gap = gap_at(end, at_end, last);
  const double gap = std::min(first_gap, last_gap);
  result_.verdict = gap <= kAlarmGap ? CcdVerdict::kCollides : CcdVerdict::kUnresolved;
  result_.cause = CcdCause::kMotion;
  result_.toi_lower = time_of(begin);
  result_.gap_bound = scale_up(gap, motion_.exponent);
  result_.weights = first_gap <= last_gap ? first.weights : last.weights;
  if (is_zero(separating_)) separating_ = first.direction;
}

void Search::answer_end() {
  const ClosestPoint closest = closest_point(motion_.kind, motion_.t1);
  const double lower =
      std::max(distance_lower(motion_.corner_count, motion_.t1, motion_.extent, closest.direction),
               distance_lower(motion_.corner_count, motion_.t1, motion_.extent, normalize_exponent(closest.point)));
  const double upper = gap_at(kTicks, motion_.t1, closest);
  result_.toi_lower = 1;
  result_.weights = closest.weights;
  separating_ = closest.direction;
  if (scale_down(lower, motion_.exponent) > options_.tolerance || options_.tolerance == 0) {
    result_.verdict = CcdVerdict::kSeparated;
    result_.cause = CcdCause::kNone;
    return;
  }
  result_.verdict = CcdVerdict::kCollides;
  result_.cause = CcdCause::kEnd;
  result_.gap_bound = scale_up(upper, motion_.exponent);
}

CcdResult Search::run() {
  std::uint64_t begin = 0, width = kTicks;
  DifferencePolygon at_begin = motion_.t0;
  while (begin < kTicks) {
    if (result_.intervals >= options_.max_intervals) {
      result_.toi_lower = time_of(begin);
      return result_;
    }
    ++result_.intervals;
    const std::uint64_t end = begin + width;
    const DifferencePolygon at_end = end == kTicks ? motion_.t1 : polygon_at(motion_, time_of(end));
    if (certify(begin, end, at_begin, at_end)) {
      begin = end;
      at_begin = at_end;
      width = begin & (~begin + 1);  // the next interval of the binary tree: its lowest set bit
    } else if (width > 1) {
      width /= 2;
    } else {
      answer_contact(begin, end, at_begin, at_end);
      break;
    }
  }
  if (begin == kTicks) answer_end();
  const double length = norm(separating_);
  if (length > 0) result_.normal = to_vec3((1 / length) * separating_);
  return result_;
}

CcdResult query(PairKind kind, const std::array<Double3, 4>& x_t0, const std::array<Double3, 4>& x_t1,
                const CcdOptions& options) {
  const bool valid_tolerance = options.tolerance >= 0 && options.tolerance < std::numeric_limits<double>::infinity();
  if (!valid_tolerance || !in_domain(x_t0) || !in_domain(x_t1)) return {};
  const CanonicalPair pair = canonical_order(kind, x_t0, x_t1);
  const PairMotion motion = make_pair_motion(kind, pair.x_t0, pair.x_t1);
  CcdResult result = Search(motion, options).run();
  result.weights = restore_weights(pair, result.weights);
  result.normal = to_vec3(restore_normal(pair, to_double3(result.normal)));
  return result;
}

std::array<Double3, 4> to_points(const std::array<Vec3, 4>& x) {
  return {to_double3(x[0]), to_double3(x[1]), to_double3(x[2]), to_double3(x[3])};
}
std::array<Double3, 4> to_points(const std::array<Vec3, 3>& x) {
  return {to_double3(x[0]), to_double3(x[1]), to_double3(x[2]), Double3{}};
}

}  // namespace

CcdResult vf_ccd_unguarded(const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1,
                           const CcdOptions& options) {
  return query(PairKind::kVf, to_points(x_t0), to_points(x_t1), options);
}

CcdResult ee_ccd_unguarded(const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1,
                           const CcdOptions& options) {
  return query(PairKind::kEe, to_points(x_t0), to_points(x_t1), options);
}

CcdResult self_ccd_unguarded(const std::array<Vec3, 3>& x_t0, const std::array<Vec3, 3>& x_t1,
                             const CcdOptions& options) {
  return query(PairKind::kSelf, to_points(x_t0), to_points(x_t1), options);
}

}  // namespace selvage::detail
