#include "verify/smallest_gap.h"

#include <bit>
#include <limits>
#include <tuple>

#include <tbb/enumerable_thread_specific.h>

#include "verify/arithmetic/fp_guard.h"
#include "verify/decision/exact_distance.h"
#include "verify/filter/distance_filter.h"
#include "verify/near_pairs.h"

namespace selvage::verify {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Candidate {
  double distance = kInfinity;
  EventKind event = EventKind::kVf;
  std::array<std::int32_t, 2> features{};
  std::array<Point, 4> x{};
};

FeaturePair feature_pair(const Candidate& pair) { return {pair.event == EventKind::kVf, pair.x}; }

// The least of a set does not depend on who finds it: ties are broken by name.

bool is_named_before(const Candidate& a, const Candidate& b) {
  return std::tie(a.event, a.features) < std::tie(b.event, b.features);
}

/// For distances that are estimates.
bool is_less_by_estimate(const Candidate& a, const Candidate& b) {
  return a.distance != b.distance ? a.distance < b.distance : is_named_before(a, b);
}

/// For distances that are the smallest double not below the exact one: where these are equal the exact ones decide.
bool is_less(const Candidate& a, const Candidate& b) {
  if (a.distance != b.distance) return a.distance < b.distance;
  const int order = a.distance == 0 ? 0 : compare_distances(feature_pair(a), feature_pair(b));
  return order != 0 ? order < 0 : is_named_before(a, b);
}

int compare_distance(const Candidate& pair, double d) {
  return pair.event == EventKind::kVf ? compare_vf_distance(pair.x, d) : compare_ee_distance(pair.x, d);
}

/// The smallest double that is not below the exact distance. Doubles that are not negative are ordered as their bits
/// are; from the estimate, which is rarely off by more than a few, steps that double find both sides, then bisection.
double distance_upper(const Candidate& pair) {
  const auto is_enough = [&](std::uint64_t bits) {
    const double d = std::bit_cast<double>(bits);
    return d == kInfinity || compare_distance(pair, d) <= 0;
  };
  const auto most = std::bit_cast<std::uint64_t>(kInfinity);
  const double estimate = pair.event == EventKind::kVf ? estimate_vf_distance(pair.x) : estimate_ee_distance(pair.x);
  std::uint64_t high = std::min(std::bit_cast<std::uint64_t>(estimate), most), low = high;
  for (std::uint64_t step = 1; !is_enough(high); step *= 2) {
    low = high + 1;
    high = step < most - high ? high + step : most;
  }
  for (std::uint64_t step = 1; low > 0 && is_enough(low); step *= 2) {
    high = low;
    low = step < low ? low - step : 0;
  }
  while (low < high) {  // every double below low is too small, high is enough
    const std::uint64_t middle = low + (high - low) / 2;
    (is_enough(middle) ? high : low) = is_enough(middle) ? middle : middle + 1;
  }
  return std::bit_cast<double>(high);
}

/// The least of `start` and the pairs within `reach`, with the distance that rate(pair, least so far) gives: nothing
/// where it need not be looked at.
template <class Rate, class Less>
Candidate least(const Topology& topology, std::span<const Point> V, double reach, const CheckOptions& options,
                Candidate start, const Rate& rate, const Less& less) {
  tbb::enumerable_thread_specific<Candidate> bests(start);
  Tally no_tally(0, options.stop);
  visit_near_pairs(topology, V, reach, options.check_bodies, 0, no_tally,
                   [&](EventKind event, std::int32_t i, std::int32_t j, const std::array<Point, 4>& x, Tally&) {
                     Candidate& best = bests.local();
                     Candidate pair{kInfinity, event, {i, j}, x};
                     const std::optional<double> distance = rate(pair, best.distance);
                     if (!distance) return;
                     pair.distance = *distance;
                     if (less(pair, best)) best = pair;
                   });
  for (const Candidate& best : bests) {
    if (less(best, start)) start = best;
  }
  return start;
}

/// Some pair that is near, by estimates: among those whose boxes overlap, and where there are none, at growing
/// distance.
std::optional<Candidate> near_pair(const Topology& topology, std::span<const Point> V, const CheckOptions& options) {
  const Box bounds = bulk_box(topology, V);
  double extent = 0;
  for (std::size_t k = 0; k < 3; ++k) extent = std::max(extent, 0.5 * bounds.max[k] - 0.5 * bounds.min[k]);
  const auto estimate = [](const Candidate& pair, double) -> std::optional<double> {
    return pair.event == EventKind::kVf ? estimate_vf_distance(pair.x) : estimate_ee_distance(pair.x);
  };
  // From boxes that overlap to all pairs.
  for (const double share : {0.0, 0x1p-20, 0x1p-15, 0x1p-10, 0x1p-5, kInfinity}) {
    const double reach = share < kInfinity ? extent * share : std::numeric_limits<double>::max();
    const Candidate nearest = least(topology, V, reach, options, {}, estimate, is_less_by_estimate);
    if (nearest.distance < kInfinity) return nearest;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Gap> smallest_gap(const Topology& topology, std::span<const Point> V, const CheckOptions& options) {
  const FpGuard guard;
  require_positions(topology, V);
  std::optional<Candidate> best = near_pair(topology, V, options);
  if (!best) return std::nullopt;
  best->distance = distance_upper(*best);
  const double reach = std::min(best->distance, std::numeric_limits<double>::max());
  const auto exact_upper = [](const Candidate& pair, double least_so_far) -> std::optional<double> {
    const bool is_vf = pair.event == EventKind::kVf;
    if (is_vf ? triage_vf_farther(pair.x, least_so_far) : triage_ee_farther(pair.x, least_so_far)) return std::nullopt;
    return distance_upper(pair);
  };
  best = least(topology, V, reach, options, *best, exact_upper, is_less);
  Gap gap{best->distance, best->distance, 0, best->event, best->features, {best->x.begin(), best->x.end()}};
  const bool is_rounded = gap.upper == kInfinity || compare_distance(*best, gap.upper) != 0;
  if (is_rounded) gap.lower = std::bit_cast<double>(std::bit_cast<std::uint64_t>(gap.upper) - 1);
  return gap;
}

bool is_smaller(const Gap& a, const Gap& b) {
  if (a.upper != b.upper) return a.upper < b.upper;
  if (a.lower != b.lower) return a.lower < b.lower;
  if (a.lower == a.upper || a.x.size() != 4 || b.x.size() != 4) return false;
  const FpGuard guard;
  const auto pair = [](const Gap& gap) {
    return FeaturePair{gap.event == EventKind::kVf, {gap.x[0], gap.x[1], gap.x[2], gap.x[3]}};
  };
  return compare_distances(pair(a), pair(b)) < 0;
}

}  // namespace selvage::verify
