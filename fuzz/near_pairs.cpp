#include "fuzz/near_pairs.h"

#include <algorithm>
#include <set>
#include <utility>

namespace selvage::fuzz {

std::vector<verify::Point> raw_points(const Positions& x) {
  std::vector<verify::Point> points;
  points.reserve(static_cast<std::size_t>(x.rows()));
  for (Eigen::Index i = 0; i < x.rows(); ++i) points.push_back({x(i, 0), x(i, 1), x(i, 2)});
  return points;
}

std::vector<verify::Violation> near_pairs(const verify::Topology& topology, const Positions& x, double distance) {
  verify::CheckOptions options;
  options.min_distance = distance;
  options.max_violations = 1'000'000;
  std::vector<verify::Violation> near = verify::check_frame(topology, raw_points(x), options).violations;
  std::erase_if(near, [](const verify::Violation& violation) { return violation.kind != "near"; });
  return near;
}

bool all_are_named(std::span<const verify::Violation> near, std::span<const Collision> named) {
  std::set<std::pair<PairKind, std::array<std::int32_t, 2>>> names;
  for (const Collision& pair : named) names.insert({pair.kind, {pair.first, pair.second}});
  return std::ranges::all_of(near, [&](const verify::Violation& violation) {
    const PairKind kind = violation.event == verify::EventKind::kVf ? PairKind::kVf : PairKind::kEe;
    return names.contains({kind, violation.features});
  });
}

}  // namespace selvage::fuzz
