#include "verify/distance_check.h"

#include <cmath>
#include <limits>
#include <stdexcept>

#include "verify/arithmetic/fp_guard.h"
#include "verify/decision/exact_distance.h"
#include "verify/filter/distance_filter.h"
#include "verify/near_pairs.h"
#include "verify/tally.h"
#include "verify/violation.h"

namespace selvage::verify {

void check_distances(const Topology& topology, std::span<const Point> V, double distance, const CheckOptions& options,
                     Tally& tally) {
  if (!(distance >= 0) || !std::isfinite(distance)) {
    throw std::invalid_argument("the minimum distance must be finite and not negative");
  }
  visit_near_pairs(topology, V, distance, options.check_bodies, options.max_violations, tally,
                   [&](EventKind event, std::int32_t i, std::int32_t j, const std::array<Point, 4>& x, Tally& chunk) {
                     const bool is_vf = event == EventKind::kVf;
                     ++(is_vf ? chunk.pairs.vf : chunk.pairs.ee);
                     if (is_vf ? triage_vf_farther(x, distance) : triage_ee_farther(x, distance)) return;
                     ++chunk.pairs.exact;
                     const int sign = is_vf ? compare_vf_distance(x, distance) : compare_ee_distance(x, distance);
                     if (sign < 0) chunk.add({event, {i, j}, "near"});
                   });
}

std::vector<Violation> near_pairs(const Topology& topology, std::span<const Point> V, double distance) {
  const FpGuard guard;
  require_positions(topology, V);
  CheckOptions options;
  options.max_violations = static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max());
  Tally tally(options.max_violations, options.stop);
  check_distances(topology, V, distance, options, tally);
  std::vector<Violation> near;
  for (const Hit& hit : tally.first_hits()) {
    near.push_back(describe(topology, hit));
    set_positions(near.back(), V, V);
  }
  return near;
}

}  // namespace selvage::verify
