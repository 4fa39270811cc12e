#include "sim/contact/near_pairs.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <span>

#include "kernel/fp_env.h"
#include "kernel/lanes/lane_motion.h"
#include "kernel/own_tasks.h"
#include "sim/base/parallel.h"
#include "sim/contact/contact_reach.h"
#include "sim/contact/quick_proximity.h"

namespace selvage::sim {
namespace {

/// Room for the rounding of quick_proximity where distances are compared. Too much costs queries, too little an answer:
/// far above 2^-52, far below what tells two pairs apart.
constexpr double kRounding = 1 + 1e-6;

/// Of the thickness: as far as a fall counts. Cloth that rests on cloth is nearer than that. Without a limit stretches
/// of sim/scenes/curtain.toml take up to 1.25 times the time, with it up to 1.13
/// (docs/measurements/simulator-speed.md).
constexpr double kMaxFallShare = 1.0 / 8;

/// Candidates of one task. The tasks are the same for any number of threads, and so is the order of what they find.
constexpr std::size_t kTaskSize = 4 * detail::kPairBlock;

/// What the tasks found, each what it was given in order.
template <typename Candidate>
struct Found {
  struct Task {
    std::vector<NearPair> pairs;
    std::vector<Candidate> candidates;
  };
  std::vector<Task> tasks;

  [[nodiscard]] std::size_t count() const {
    return std::accumulate(tasks.begin(), tasks.end(), std::size_t{0},
                           [](std::size_t sum, const Task& task) { return sum + task.pairs.size(); });
  }
  /// Joins them. REQUIRES room for count().
  void copy_to(NearPair* pairs, Candidate* candidates) const {
    std::vector<std::size_t> begin(tasks.size());
    for (std::size_t i = 1; i < tasks.size(); ++i) begin[i] = begin[i - 1] + tasks[i - 1].pairs.size();
    own_parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t i) {
      std::ranges::copy(tasks[i].pairs, pairs + begin[i]);
      std::ranges::copy(tasks[i].candidates, candidates + begin[i]);
    });
  }
};

template <typename Candidate>
void find_block(const Mesh& mesh, const ContactTable& contacts, std::span<const Candidate> block, const Positions& V,
                QuickProximities& quick, typename Found<Candidate>::Task& found) {
  const detail::LanePairs lanes(mesh, block);
  quick_proximities(lanes, V, quick);
  for (std::size_t i = 0; i < block.size(); ++i) {
    std::array<VertexId, 4> vertices{};
    for (std::size_t k = 0; k < 4; ++k) vertices[k] = static_cast<VertexId>(lanes.vertices(k)[i]);
    const auto [first, second] = block[i];
    const double thickness_m = contacts.of(lanes.kind(), first, second).thickness_m;
    if (quick.distance[i] > kRounding * kContactReach * thickness_m) continue;
    const QuickProximity proximity = quick[i];
    found.pairs.push_back({vertices, proximity.weights, proximity.direction, proximity.distance, thickness_m});
    found.candidates.push_back(block[i]);
  }
}

template <typename Candidate>
Found<Candidate> find_near(const Mesh& mesh, const ContactTable& contacts, const std::vector<Candidate>& all,
                           const Positions& V) {
  Found<Candidate> found{std::vector<typename Found<Candidate>::Task>((all.size() + kTaskSize - 1) / kTaskSize)};
  own_parallel_for(std::size_t{0}, found.tasks.size(), [&](std::size_t task) {
    const FpEnvGuard guard;
    QuickProximities quick;
    const std::size_t end = std::min(all.size(), (task + 1) * kTaskSize);
    for (std::size_t first = task * kTaskSize; first < end; first += detail::kPairBlock) {
      const auto block = std::span(all).subspan(first, std::min(detail::kPairBlock, end - first));
      find_block(mesh, contacts, block, V, quick, found.tasks[task]);
    }
  });
  return found;
}

bool comes_near(const NearPair& pair, const Positions& V_t0, const Positions& V_t1, const Vec3& fall) {
  Vec3 moved = Vec3::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    const VertexId v = pair.vertices[k];
    moved += pair.weights[k] * (V_t1.row(v) - V_t0.row(v)).transpose();
  }
  const double fallen = std::min(std::abs(fall.dot(pair.direction)), kMaxFallShare * pair.thickness_m);
  return !(pair.distance + moved.dot(pair.direction) - fallen >= pair.thickness_m);
}

/// The numbers below `count` for which is_one(i), ascending; asked in parallel.
template <typename IsOne>
std::vector<std::size_t> those_where(std::size_t count, const IsOne& is_one) {
  std::vector<std::uint8_t> answer(count);
  parallel_each(static_cast<Eigen::Index>(count), [&](Eigen::Index i) {
    const auto at = static_cast<std::size_t>(i);
    answer[at] = is_one(at);
  });
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < count; ++i) {
    if (answer[i] != 0) result.push_back(i);
  }
  return result;
}

}  // namespace

void NearPairs::find(const Mesh& mesh, const ContactTable& contacts, const Candidates& candidates,
                     const Positions& V_t0) {
  vertex_count_ = V_t0.rows();
  const auto vf = find_near(mesh, contacts, candidates.vf, V_t0);
  const auto ee = find_near(mesh, contacts, candidates.ee, V_t0);
  candidates_.vf.resize(vf.count());
  candidates_.ee.resize(ee.count());
  pairs_.resize(vf.count() + ee.count());
  vf.copy_to(pairs_.data(), candidates_.vf.data());
  ee.copy_to(pairs_.data() + vf.count(), candidates_.ee.data());
}

std::vector<std::size_t> NearPairs::approaching(const Positions& V_t0, const Positions& V_t1, const Vec3& fall) const {
  return those_where(pairs_.size(), [&](std::size_t i) { return comes_near(pairs_[i], V_t0, V_t1, fall); });
}

std::vector<std::size_t> NearPairs::with_nearer(const std::vector<std::size_t>& pairs) const {
  std::vector<double> reach(static_cast<std::size_t>(vertex_count_), -1);  // the farthest of `pairs` at each vertex
  for (const std::size_t i : pairs) {
    for (const VertexId v : pairs_[i].vertices) {
      double& farthest = reach[static_cast<std::size_t>(v)];
      farthest = std::max(farthest, kRounding * pairs_[i].distance);
    }
  }
  std::vector<std::size_t> nearer = those_where(pairs_.size(), [&](std::size_t i) {
    const NearPair& pair = pairs_[i];
    const auto is_nearer = [&](VertexId v) { return pair.distance <= reach[static_cast<std::size_t>(v)]; };
    const auto* second_side = pair.vertices.begin() + (i < candidates_.vf.size() ? 1 : 2);
    return std::any_of(pair.vertices.begin(), second_side, is_nearer) &&
           std::any_of(second_side, pair.vertices.end(), is_nearer);
  });
  std::vector<std::size_t> result;
  std::ranges::set_union(pairs, nearer, std::back_inserter(result));  // a distance may be NaN
  return result;
}

bool NearPairs::is_pair(std::size_t i, PairKind kind, std::int32_t first, std::int32_t second) const {
  const std::size_t vf_count = candidates_.vf.size();
  if (i < vf_count) return kind == PairKind::kVf && candidates_.vf[i] == VfCandidate{first, second};
  return kind == PairKind::kEe && candidates_.ee[i - vf_count] == EeCandidate{first, second};
}

std::optional<std::size_t> NearPairs::place(PairKind kind, std::int32_t first, std::int32_t second) const {
  const auto place_in = [](const auto& sorted, const auto& pair) -> std::optional<std::size_t> {
    const auto at = std::ranges::lower_bound(sorted, pair);
    if (at == sorted.end() || *at != pair) return std::nullopt;
    return static_cast<std::size_t>(at - sorted.begin());
  };
  if (kind == PairKind::kVf) return place_in(candidates_.vf, VfCandidate{first, second});
  const auto ee = place_in(candidates_.ee, EeCandidate{first, second});
  if (!ee) return std::nullopt;
  return candidates_.vf.size() + *ee;
}

std::vector<std::size_t> NearPairs::places(const Candidates& pairs) const {
  std::vector<std::size_t> result;
  const auto add = [&](PairKind kind, std::int32_t first, std::int32_t second) {
    if (const auto at = place(kind, first, second)) result.push_back(*at);
  };
  for (const auto& [vertex, face] : pairs.vf) add(PairKind::kVf, vertex, face);
  for (const auto& [a, b] : pairs.ee) add(PairKind::kEe, a, b);
  return result;
}

Candidates NearPairs::candidates(const std::vector<std::size_t>& pairs) const {
  Candidates result;
  for (const std::size_t i : pairs) {
    if (i < candidates_.vf.size()) {
      result.vf.push_back(candidates_.vf[i]);
    } else {
      result.ee.push_back(candidates_.ee[i - candidates_.vf.size()]);
    }
  }
  return result;
}

}  // namespace selvage::sim
