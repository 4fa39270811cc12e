#include "kernel/proximities.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <span>

#include "kernel/assert.h"
#include "kernel/candidates.h"
#include "kernel/fp_env.h"
#include "kernel/lanes/lane_cull.h"
#include "kernel/own_tasks.h"
#include "kernel/query/ccd_detail.h"

namespace selvage {

namespace {

/// Candidates of one task: most of them cost 15 ns. The tasks are the same for any number of threads, and so is the
/// order of what they find (K7).
constexpr std::size_t kTaskSize = 4096;

/// Calls body(those of one task, found) for all `items`. Returns what each task found, in order.
template <typename Found, typename Item, typename Body>
std::vector<std::vector<Found>> for_each_task(const std::vector<Item>& items, const Body& body) {
  std::vector<std::vector<Found>> tasks((items.size() + kTaskSize - 1) / kTaskSize);
  own_parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t task) {
    const FpEnvGuard guard;
    const auto rest = std::span(items).subspan(task * kTaskSize);
    body(rest.first(std::min(kTaskSize, rest.size())), tasks[task]);
  });
  return tasks;
}

template <typename Found>
std::vector<Found> joined(std::initializer_list<std::span<const std::vector<Found>>> all_tasks) {
  std::size_t count = 0;
  for (const auto& tasks : all_tasks) {
    for (const auto& task : tasks) count += task.size();
  }
  std::vector<Found> all;
  all.reserve(count);
  for (const auto& tasks : all_tasks) {
    for (const auto& task : tasks) all.insert(all.end(), task.begin(), task.end());
  }
  return all;
}

/// A pair that does not move and is PROVED farther apart than the reach at the end is so all along.
template <typename Candidate>
std::vector<Candidate> not_proved_apart(const Mesh& mesh, const detail::LaneMotion& still, double reach,
                                        const std::vector<Candidate>& candidates) {
  const auto left_by_task = for_each_task<Candidate>(candidates, [&](std::span<const Candidate> task, auto& found) {
    detail::PairNumbers left;
    for (std::size_t first = 0; first < task.size(); first += detail::kPairBlock) {
      const auto pairs = task.subspan(first, std::min(detail::kPairBlock, task.size() - first));
      cull_in_lanes(still, detail::LanePairs(mesh, pairs), reach, left);
      for (const std::uint32_t i : std::span(left.place).first(left.count)) found.push_back(pairs[i]);
    }
  });
  return joined<Candidate>({left_by_task});
}

template <typename Candidate, typename Query>
std::vector<std::vector<PairProximity>> ask(const Mesh& mesh, const PositionsRef& V, double reach, PairKind kind,
                                            const std::vector<Candidate>& candidates, const Query& query) {
  return for_each_task<PairProximity>(candidates, [&](std::span<const Candidate> task, auto& found) {
    for (const auto& [first, second] : task) {
      const auto v = pair_vertices(mesh, kind, first, second);
      const Proximity proximity = query({V.row(v[0]), V.row(v[1]), V.row(v[2]), V.row(v[3])});
      if (!(proximity.distance_lower >= reach)) found.push_back({kind, first, second, v, proximity});
    }
  });
}

}  // namespace

Candidates find_near_candidates(const Mesh& mesh, BoxHierarchy& hierarchy, const PositionsRef& V, double reach,
                                std::span<const std::uint8_t> active) {
  const FpEnvGuard guard;  // the rows of the lanes are rounded to float32 here
  SELVAGE_REQUIRE(validate(mesh, V, V) == InputError::kNone);
  SELVAGE_REQUIRE(reach >= 0 && std::isfinite(reach));
  SELVAGE_REQUIRE(hierarchy.fits(mesh));
  hierarchy.refit(V, V, {reach, active});
  Candidates candidates = hierarchy.candidates();
  // As in CcdBatch: preparing the lanes costs 35 ns a vertex, a query that they spare 400 ns.
  constexpr std::size_t kVerticesPerQuery = 4;
  const std::size_t count = candidates.vf.size() + candidates.ee.size();
  if (count * kVerticesPerQuery < static_cast<std::size_t>(V.rows())) return candidates;
  const detail::LaneMotion still(V, V);
  SELVAGE_ASSERT(still.is_valid());  // the domain of validate()
  return {not_proved_apart(mesh, still, reach, candidates.vf), not_proved_apart(mesh, still, reach, candidates.ee)};
}

std::vector<PairProximity> ask_proximities(const Mesh& mesh, const PositionsRef& V, const Candidates& candidates,
                                           double reach) {
  const auto vf = ask(mesh, V, reach, PairKind::kVf, candidates.vf, detail::vf_proximity_unguarded);
  const auto ee = ask(mesh, V, reach, PairKind::kEe, candidates.ee, detail::ee_proximity_unguarded);
  return joined<PairProximity>({vf, ee});
}

std::vector<PairProximity> find_proximities(const Mesh& mesh, BoxHierarchy& hierarchy, const PositionsRef& V,
                                            double reach, std::span<const std::uint8_t> active) {
  return ask_proximities(mesh, V, find_near_candidates(mesh, hierarchy, V, reach, active), reach);
}

}  // namespace selvage
