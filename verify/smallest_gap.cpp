#include "verify/smallest_gap.h"

#include <bit>
#include <limits>
#include <tuple>

#include <tbb/enumerable_thread_specific.h>

#include "verify/distance_filter.h"
#include "verify/exact_distance.h"
#include "verify/fp_guard.h"
#include "verify/near_pairs.h"

namespace selvage::verify {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Ordered by distance, then by name: the least of a set does not depend on who finds it.
struct Candidate {
  double distance = kInfinity;
  EventKind event = EventKind::kVf;
  std::array<std::int32_t, 2> features{};
  std::array<Point, 4> x{};

  friend bool operator<(const Candidate& a, const Candidate& b) {
    return std::tie(a.distance, a.event, a.features) < std::tie(b.distance, b.event, b.features);
  }
};

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

/// The least of what rate(pair, least so far) gives for the pairs within `reach`; infinite where there is none.
template <class Rate>
Candidate least(const Topology& topology, std::span<const Point> V, double reach, bool check_bodies, Candidate start,
                const Rate& rate) {
  tbb::enumerable_thread_specific<Candidate> bests(start);
  Tally no_tally(0);
  visit_near_pairs(topology, V, reach, check_bodies, 0, no_tally,
                   [&](EventKind event, std::int32_t i, std::int32_t j, const std::array<Point, 4>& x, Tally&) {
                     Candidate& best = bests.local();
                     Candidate pair{kInfinity, event, {i, j}, x};
                     pair.distance = rate(pair, best.distance);
                     if (pair < best) best = pair;
                   });
  for (const Candidate& best : bests) {
    if (best < start) start = best;
  }
  return start;
}

/// Some pair that is near, by estimates: among those whose boxes overlap, and where there are none, at growing
/// distance.
std::optional<Candidate> near_pair(const Topology& topology, std::span<const Point> V, bool check_bodies) {
  const Box bounds = bounding_box(V);
  double extent = 0;
  for (std::size_t k = 0; k < 3; ++k) extent = std::max(extent, 0.5 * bounds.max[k] - 0.5 * bounds.min[k]);
  const auto estimate = [](const Candidate& pair, double) {
    return pair.event == EventKind::kVf ? estimate_vf_distance(pair.x) : estimate_ee_distance(pair.x);
  };
  // From boxes that overlap to the whole bounding box: it is twice `extent` wide.
  for (const double share : {0.0, 0x1p-20, 0x1p-15, 0x1p-10, 0x1p-5, 0x1p+2}) {
    const double reach = std::min(extent * share, std::numeric_limits<double>::max());
    const Candidate nearest = least(topology, V, reach, check_bodies, {}, estimate);
    if (nearest.distance < kInfinity) return nearest;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Gap> smallest_gap(const Topology& topology, std::span<const Point> V, bool check_bodies) {
  const FpGuard guard;
  require_positions(topology, V);
  if (V.empty()) return std::nullopt;
  std::optional<Candidate> best = near_pair(topology, V, check_bodies);
  if (!best) return std::nullopt;
  best->distance = distance_upper(*best);
  const double reach = std::min(best->distance, std::numeric_limits<double>::max());
  best = least(topology, V, reach, check_bodies, *best, [](const Candidate& pair, double least_so_far) {
    const bool is_vf = pair.event == EventKind::kVf;
    const bool farther = is_vf ? triage_vf_farther(pair.x, least_so_far) : triage_ee_farther(pair.x, least_so_far);
    return farther ? kInfinity : distance_upper(pair);
  });
  Gap gap{best->distance, best->distance, 0, best->event, best->features};
  const bool is_rounded = gap.upper == kInfinity || compare_distance(*best, gap.upper) != 0;
  if (is_rounded) gap.lower = std::bit_cast<double>(std::bit_cast<std::uint64_t>(gap.upper) - 1);
  return gap;
}

}  // namespace selvage::verify
