#include "kernel/collisions.h"

#include <algorithm>
#include <atomic>
#include <tuple>

#include <tbb/enumerable_thread_specific.h>

#include "kernel/assert.h"
#include "kernel/box.h"
#include "kernel/ccd_batch.h"
#include "kernel/fp_env.h"
#include "kernel/own_tasks.h"

namespace selvage {

namespace {

/// Items of one task. The blocks are the same for any number of threads, and so is the order of what they find (K7).
/// 512 queries of some 50 ns cost far more than starting a task.
constexpr std::size_t kBlockSize = 512;
/// Candidates of one task: most of them cost 15 ns, and answers do not depend on the division (CcdBatch).
constexpr std::size_t kBatchSize = 4096;

/// Calls body(item, found) for items 0 .. count-1 and joins what the blocks found in order.
template <typename Found, typename Body>
std::vector<Found> for_each_block(std::size_t count, const Body& body) {
  std::vector<Found> blocks((count + kBlockSize - 1) / kBlockSize);
  own_parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t block) {
    const FpEnvGuard guard;
    const std::size_t end = std::min(count, (block + 1) * kBlockSize);
    for (std::size_t item = block * kBlockSize; item < end; ++item) body(item, blocks[block]);
  });
  return blocks;
}

template <std::size_t N>
std::array<Vec3, N> points(const PositionsRef& V, const std::array<VertexId, 4>& vertices) {
  std::array<Vec3, N> x;
  for (std::size_t k = 0; k < N; ++k) x[k] = V.row(vertices[k]);
  return x;
}

/// Thrown in a task where there are more collisions than are wanted: oneTBB ends all others.
struct TooMany {};

class CollisionFinder {
 public:
  CollisionFinder(const Mesh& mesh, const PositionsRef& V_t0, const PositionsRef& V_t1, const CcdOptions& options,
                  std::span<const std::uint8_t> active, const CollisionLimits& limits)
      : mesh_(mesh), V_t0_(V_t0), V_t1_(V_t1), options_(options), active_(active), limits_(limits) {}

  CollisionReport find(const Candidates& candidates) {
    const CcdBatch batch(mesh_, V_t0_, V_t1_, options_, candidates.vf.size() + candidates.ee.size());
    ask_all(batch, PairKind::kVf, candidates.vf);
    ask_all(batch, PairKind::kEe, candidates.ee);
    return take();
  }

  /// Of `more_than` candidates and more, part by part: answers do not depend on how a list is divided (CcdBatch).
  CollisionReport find(const BoxHierarchy& hierarchy, std::size_t more_than) {
    const CcdBatch batch(mesh_, V_t0_, V_t1_, options_, more_than);
    tbb::enumerable_thread_specific<Block> blocks;
    hierarchy.visit_candidates([&](const Candidates& part) {
      ask(batch, PairKind::kVf, std::span(part.vf), blocks.local());
      ask(batch, PairKind::kEe, std::span(part.ee), blocks.local());
    });
    join(blocks);
    return take();
  }

 private:
  struct Block {
    std::vector<Collision> collisions;
    std::int64_t vf_candidates = 0, ee_candidates = 0, self_candidates = 0, intervals = 0;

    void count(std::span<const VfCandidate> pairs) { vf_candidates += std::ssize(pairs); }
    void count(std::span<const EeCandidate> pairs) { ee_candidates += std::ssize(pairs); }
  };

  /// With what faces meet of their own corners.
  CollisionReport take() {
    join(for_each_block<Block>(mesh_.faces.size(), [&](std::size_t f, Block& block) { query_face(f, block); }));
    std::ranges::sort(report_.collisions, {}, [](const Collision& c) { return std::tuple(c.kind, c.first, c.second); });
    return std::move(report_);
  }

  template <typename Pair>
  void ask_all(const CcdBatch& batch, PairKind kind, const std::vector<Pair>& candidates) {
    std::vector<Block> blocks((candidates.size() + kBatchSize - 1) / kBatchSize);
    own_parallel_for(std::size_t{0}, blocks.size(), [&](std::size_t b) {
      const auto pairs = std::span(candidates).subspan(b * kBatchSize);
      ask(batch, kind, pairs.first(std::min(kBatchSize, pairs.size())), blocks[b]);
    });
    join(blocks);
  }

  template <typename Pair>
  void ask(const CcdBatch& batch, PairKind kind, std::span<const Pair> pairs, Block& block) const {
    const FpEnvGuard guard;  // for moves_near()
    const BatchReport report = batch.ask(pairs);
    for (const BatchAnswer& answer : report.answers) {
      const auto& pair = pairs[answer.candidate];
      if (!moves_near(kind, pair_vertices(mesh_, pair))) continue;
      const auto [first, second] = pair;
      add({kind, first, second, answer.ccd}, block);
    }
    block.intervals += report.intervals;
    block.count(pairs);
  }

  void add(const Collision& collision, Block& block) const {
    block.collisions.push_back(collision);
    const bool is_near = collision.ccd.cause == CcdCause::kEnd;
    auto& count = is_near ? near_count_ : motion_count_;
    const std::size_t most = is_near ? limits_.most_near : limits_.most_collisions;
    if (count.fetch_add(1, std::memory_order_relaxed) >= most) throw TooMany();
  }

  /// Asked of what was found, too: else what is found would depend on which boxes the candidates come from.
  [[nodiscard]] bool moves_near(PairKind kind, const std::array<VertexId, 4>& vertices) const {
    const auto box = [&](std::size_t k) {
      return vertex_box(V_t0_, V_t1_, vertices[k], options_.tolerance, MotionBoxes::kMoving);
    };
    if (kind == PairKind::kVf) return overlap(box(0), united(united(box(1), box(2)), box(3)));
    return overlap(united(box(0), box(1)), united(box(2), box(3)));
  }

  void query_self(VertexId vertex, FaceId face, Block& block) const {
    const auto vertices = pair_vertices(mesh_, PairKind::kSelf, vertex, face);
    const CcdResult ccd = self_ccd(points<3>(V_t0_, vertices), points<3>(V_t1_, vertices), options_);
    block.intervals += ccd.intervals;
    if (ccd.verdict != CcdVerdict::kSeparated) add({PairKind::kSelf, vertex, face, ccd}, block);
  }

  /// Each corner of the face against the opposite edge.
  void query_face(std::size_t f, Block& block) const {
    const auto& corners = mesh_.faces[f];
    const auto is_active = [this](VertexId v) { return active_.empty() || active_[static_cast<std::size_t>(v)] != 0; };
    if (std::none_of(corners.begin(), corners.end(), is_active)) return;
    std::array<Box, 3> boxes;
    for (std::size_t k = 0; k < 3; ++k) boxes[k] = vertex_box(V_t0_, V_t1_, corners[k], options_.tolerance);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!overlap(boxes[k], united(boxes[(k + 1) % 3], boxes[(k + 2) % 3]))) continue;
      ++block.self_candidates;
      query_self(corners[k], static_cast<FaceId>(f), block);
    }
  }

  template <typename Blocks>
  void join(const Blocks& blocks) {
    for (const Block& block : blocks) {
      report_.collisions.insert(report_.collisions.end(), block.collisions.begin(), block.collisions.end());
      report_.intervals += block.intervals;
      report_.vf_candidates += block.vf_candidates;
      report_.ee_candidates += block.ee_candidates;
      report_.self_candidates += block.self_candidates;
      for (const Collision& collision : block.collisions) {
        report_.toi_lower = std::min(report_.toi_lower, collision.ccd.toi_lower);
      }
    }
  }

  const Mesh& mesh_;
  const PositionsRef& V_t0_;
  const PositionsRef& V_t1_;
  const CcdOptions& options_;
  std::span<const std::uint8_t> active_;
  const CollisionLimits limits_;
  mutable std::atomic<std::size_t> motion_count_ = 0, near_count_ = 0;
  CollisionReport report_;
};

}  // namespace

// A list of 32 for each vertex and edge takes a few times as long as the search in a step in which little moves. Moving
// boxes take 1.5 times as long there, and are as fast where there are 10 (docs/measurements/broad-phase.md).
std::size_t few_candidates(const Mesh& mesh) {
  return 32 * (static_cast<std::size_t>(mesh.vertex_count) + mesh.edges.size());
}

CollisionReport find_collisions(const Mesh& mesh, BoxHierarchy& hierarchy, const PositionsRef& V_t0,
                                const PositionsRef& V_t1, const CcdOptions& options,
                                std::span<const std::uint8_t> active, const CollisionLimits& limits) {
  const FpEnvGuard guard;
  SELVAGE_REQUIRE(validate(mesh, V_t0, V_t1) == InputError::kNone);
  SELVAGE_REQUIRE(validate(options) == InputError::kNone);
  SELVAGE_REQUIRE(hierarchy.fits(mesh));  // else it answers that nothing is near, or pairs that are not there
  CollisionFinder finder(mesh, V_t0, V_t1, options, active, limits);
  const auto list = [&](MotionBoxes boxes, std::size_t most) {
    hierarchy.refit(V_t0, V_t1, {options.tolerance, active, boxes});
    return hierarchy.candidates(most);
  };
  const std::size_t few = std::min(few_candidates(mesh), limits.most_listed);
  try {
    if (const auto candidates = list(MotionBoxes::kSwept, few)) return finder.find(*candidates);
    if (const auto candidates = list(MotionBoxes::kMoving, limits.most_listed)) return finder.find(*candidates);
    return finder.find(hierarchy, limits.most_listed);
  } catch (const TooMany&) {
    CollisionReport report;
    report.toi_lower = 0;
    report.is_complete = false;
    return report;
  }
}

}  // namespace selvage
