#include "kernel/broad/pair_finder.h"

#include <algorithm>
#include <atomic>
#include <iterator>

#include <tbb/blocked_range.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "kernel/broad/pair_buffer.h"
#include "kernel/broad/words.h"
#include "kernel/fp_env.h"
#include "kernel/own_tasks.h"

namespace selvage {

namespace {

TreeRef tree_ref(std::uint64_t word) { return static_cast<TreeRef>(static_cast<std::uint32_t>(word)); }

/// Ranges of rows, joined where they meet.
class RowRanges {
 public:
  void clear() {
    ranges_.clear();
    row_count_ = 0;
  }
  void add(std::size_t begin, std::size_t end) {
    row_count_ += end - begin;
    if (!ranges_.empty() && ranges_.back().end == begin) {
      ranges_.back().end = end;
    } else {
      ranges_.push_back({begin, end});
    }
  }
  void append_overlaps(const BoxColumns& boxes, const MovingBox& box, std::uint64_t first_key, Words& words) const {
    words.keep(find_overlaps(boxes, ranges_, box, first_key, words.room(row_count_ + kVectorSlack)));
  }

 private:
  std::vector<RowRange> ranges_;
  std::size_t row_count_ = 0;
};

/// Possible partners of a cluster's features, in ascending order.
template <std::size_t kCorners>
struct Partners {
  BoxColumns boxes;
  CornerColumns<kCorners> corners;

  void reuse(std::size_t count, MotionBoxes kind) {
    boxes.reuse(count, kind);
    for (auto& column : corners) {
      if (column.size() < boxes.key.size()) column.resize(boxes.key.size());
    }
  }
  void set(std::size_t row, const BoxColumns& from, std::size_t from_row, std::uint64_t feature,
           const std::array<VertexId, kCorners>& vertices) {
    boxes.copy_row(row, from, from_row);
    boxes.key[row] = feature << 32;
    for (std::size_t k = 0; k < kCorners; ++k) corners[k][row] = static_cast<std::uint64_t>(vertices[k]);
  }
};

struct Workspace {
  PairBuffer pairs;
  RowRanges ranges;
  Words below, clusters, keys, spare;
  Partners<3> faces;
  Partners<2> edges;
};

template <typename Candidate>
Candidate candidate(std::uint64_t pair) {
  return {static_cast<std::int32_t>(pair & 0xffffffff), static_cast<std::int32_t>(pair >> 32)};
}

/// Where found pairs go: into one list, unless there are too many for one.
class Listing {
 public:
  Listing(const Mesh& mesh, std::size_t most)
      : vf_(static_cast<std::size_t>(mesh.vertex_count)), ee_(mesh.edges.size()), most_(most) {}

  void add_vf(PairBuffer& /*pairs*/, VertexId first, std::span<const std::uint64_t> found) { add(vf_, first, found); }
  void add_ee(PairBuffer& /*pairs*/, EdgeId first, std::span<const std::uint64_t> found) { add(ee_, first, found); }
  [[nodiscard]] bool is_full() const { return count_ > most_; }
  [[nodiscard]] std::optional<Candidates> take() const {
    if (is_full()) return std::nullopt;
    Candidates candidates;
    collect(vf_, candidates.vf);
    collect(ee_, candidates.ee);
    return candidates;
  }

 private:
  using ByFirst = std::vector<std::span<const std::uint64_t>>;

  void add(ByFirst& pairs, std::int32_t first, std::span<const std::uint64_t> found) {
    pairs[static_cast<std::size_t>(first)] = found;
    count_.fetch_add(found.size(), std::memory_order_relaxed);
  }

  template <typename Candidate>
  static void collect(const ByFirst& found, std::vector<Candidate>& out) {
    std::vector<std::size_t> begin(found.size() + 1, 0);
    for (std::size_t i = 0; i < found.size(); ++i) begin[i + 1] = begin[i] + found[i].size();
    out.resize(begin.back());
    own_parallel_for(tbb::blocked_range<std::size_t>(0, found.size(), 1024), [&](const auto& range) {
      for (std::size_t i = range.begin(); i != range.end(); ++i) {
        std::ranges::transform(found[i], out.begin() + static_cast<std::ptrdiff_t>(begin[i]), candidate<Candidate>);
      }
    });
  }

  ByFirst vf_, ee_;
  std::size_t most_;
  std::atomic<std::size_t> count_ = 0;
};

/// Or to a visitor, in lists as long as pay for a call.
class Visiting {
 public:
  explicit Visiting(const CandidateVisitor& visit) : visit_(visit) {}

  void add_vf(PairBuffer& pairs, VertexId /*first*/, std::span<const std::uint64_t> found) {
    add(lists_.local(), &Candidates::vf, pairs, found);
  }
  void add_ee(PairBuffer& pairs, EdgeId /*first*/, std::span<const std::uint64_t> found) {
    add(lists_.local(), &Candidates::ee, pairs, found);
  }
  void finish() {
    in_own_task([&] {
      const FpEnvGuard guard;
      for (Candidates& list : lists_) give(list);
    });
  }

 private:
  static constexpr std::size_t kListSize = 4096;

  template <typename Candidate>
  void add(Candidates& list, std::vector<Candidate> Candidates::*of_kind, PairBuffer& pairs,
           std::span<const std::uint64_t> found) {
    std::ranges::transform(found, std::back_inserter(list.*of_kind), candidate<Candidate>);
    pairs.give_back(found);
    if (list.vf.size() + list.ee.size() >= kListSize) give(list);
  }
  void give(Candidates& list) {
    // A visitor that waits for parallel code of its own could be given another cluster to search meanwhile, in this
    // thread, whose list and workspace are in use.
    tbb::this_task_arena::isolate([&] { visit_(list); });
    list.vf.clear();
    list.ee.clear();
  }

  const CandidateVisitor& visit_;
  tbb::enumerable_thread_specific<Candidates> lists_;
};

template <typename Sink>
class PairFinder {
 public:
  PairFinder(const Mesh& mesh, const FaceClusters& clusters, const FittedBoxes& boxes, Sink& sink)
      : mesh_(mesh), clusters_(clusters), boxes_(boxes), sink_(sink) {}

  /// The sink's pairs are valid as long as the finder.
  void find() {
    if (!clusters_.nodes.empty()) in_own_task([&] { descend(0, {0}); });
  }

 private:
  /// One level down: the nodes in `frontier` are replaced by their children. Keeps what overlaps `box`, and only what
  /// may be active where `active_only` is set.
  void expand(const Words& frontier, const MovingBox& box, bool active_only, RowRanges& ranges, Words& out) const {
    out.clear();
    ranges.clear();
    for (const std::uint64_t word : frontier) {
      const TreeRef ref = tree_ref(word);
      if (ref >= 0) {
        const std::size_t begin = FaceClusters::kFanOut * static_cast<std::size_t>(ref);
        ranges.add(begin, begin + clusters_.nodes[static_cast<std::size_t>(ref)].child_count);
      } else if (boxes_.overlaps(ref, box)) {
        out.push_back(word);
      }
    }
    ranges.append_overlaps(boxes_.children(), box, 0, out);
    if (active_only) out.erase_if([&](std::uint64_t word) { return !boxes_.is_active(tree_ref(word)); });
  }

  /// `frontier`: nodes and clusters that hold every cluster whose box overlaps that of a cluster below node n.
  void descend(std::size_t n, const Words& frontier) {
    const FaceClusters::Node& node = clusters_.nodes[n];
    tbb::parallel_for(std::size_t{0}, node.child_count, [&](std::size_t k) {
      const FpEnvGuard guard;
      const MovingBox box = boxes_.children().row(FaceClusters::kFanOut * n + k);
      const TreeRef child = node.child[k];
      const bool active_only = !boxes_.is_active(child);
      Words below;
      RowRanges ranges;
      expand(frontier, box, active_only, ranges, below);
      if (below.empty()) return;
      if (child >= 0) {
        descend(static_cast<std::size_t>(child), below);
      } else {
        find_in_cluster(static_cast<std::size_t>(~child), box, below, active_only);
      }
    });
  }

  void find_in_cluster(std::size_t c, const MovingBox& box, const Words& frontier, bool active_only) {
    if constexpr (requires { sink_.is_full(); }) {  // a sink with a limit: what is found beyond it is thrown away
      if (sink_.is_full()) return;
    }
    Workspace& work = workspaces_.local();
    work.clusters.assign(frontier);
    const auto is_node = [](std::uint64_t word) { return tree_ref(word) >= 0; };
    while (std::any_of(work.clusters.begin(), work.clusters.end(), is_node)) {
      std::swap(work.clusters, work.below);
      expand(work.below, box, active_only, work.ranges, work.clusters);
    }
    find_vf(c, work);
    find_ee(c, work);
  }

  /// Ascending keys of the rows of work.clusters that overlap `box` and stand for first_feature or a later one.
  template <typename Id>
  static void find_keys(const PerCluster<Id>& rows, const BoxColumns& boxes, const MovingBox& box,
                        std::int32_t first_feature, Workspace& work) {
    work.ranges.clear();
    for (const std::uint64_t word : work.clusters) {
      const auto c = static_cast<std::size_t>(~tree_ref(word));
      work.ranges.add(rows.begin[c], rows.begin[c + 1]);
    }
    work.keys.clear();
    work.ranges.append_overlaps(boxes, box, static_cast<std::uint64_t>(first_feature) << 32, work.keys);
    work.keys.sort_by_high_half(work.spare);
  }

  /// Answers for all of a cluster's features: `find(feature, partners)` for each, with the partners it may have.
  template <std::size_t kCorners, typename Id, typename IsActive, typename Find>
  void match(std::span<const Id> own, const IsActive& is_active, const BoxColumns& boxes,
             const std::vector<std::array<VertexId, kCorners>>& corners, Words& keys, Partners<kCorners>& partners,
             const Find& find) const {
    const auto list_partners = [&] {
      partners.reuse(keys.size(), boxes.boxes());
      std::size_t row = 0;
      for (const std::uint64_t key : keys) {
        partners.set(row++, boxes, static_cast<std::size_t>(key & 0xffffffff), key >> 32, corners[key >> 32]);
      }
    };
    if (std::any_of(own.begin(), own.end(), is_active)) {
      list_partners();
      for (const Id id : own) {
        if (is_active(id)) find(id);
      }
    }
    if (std::all_of(own.begin(), own.end(), is_active)) return;
    keys.erase_if([&](std::uint64_t key) { return !boxes_.is_active(corners[key >> 32]); });
    list_partners();
    for (const Id id : own) {
      if (!is_active(id)) find(id);
    }
  }

  /// Row of the first partner after `feature`.
  template <std::size_t kCorners>
  static std::size_t first_after(const Partners<kCorners>& partners, std::int32_t feature) {
    const auto begin = partners.boxes.key.begin();
    const auto end = begin + static_cast<std::ptrdiff_t>(partners.boxes.row_count());
    return static_cast<std::size_t>(std::lower_bound(begin, end, (static_cast<std::uint64_t>(feature) + 1) << 32) -
                                    begin);
  }

  template <std::size_t kCorners, std::size_t kOwnCorners>
  static std::span<const std::uint64_t> find_partners(const Partners<kCorners>& partners, std::size_t begin,
                                                      const MovingBox& box,
                                                      const std::array<VertexId, kOwnCorners>& own_corners,
                                                      std::int32_t feature, PairBuffer& pairs) {
    std::uint64_t* room = pairs.room(partners.boxes.row_count() - begin + kVectorSlack);
    return pairs.keep(find_pairs(partners.boxes, partners.corners, begin, box, own_corners,
                                 static_cast<std::uint64_t>(feature), room));
  }

  void find_vf(std::size_t c, Workspace& work) {
    const auto own = clusters_.vertices.of(c);
    if (own.empty()) return;
    MovingBox all;
    for (const VertexId v : own) all.merge(boxes_.vertex(v));
    find_keys(clusters_.faces, boxes_.faces(), all, 0, work);
    const auto is_active = [&](VertexId v) { return boxes_.is_active(std::array{v}); };
    match(own, is_active, boxes_.faces(), mesh_.faces, work.keys, work.faces, [&](VertexId v) {
      sink_.add_vf(work.pairs, v, find_partners(work.faces, 0, boxes_.vertex(v), std::array{v}, v, work.pairs));
    });
  }

  void find_ee(std::size_t c, Workspace& work) {
    const auto own = clusters_.edges.of(c);
    if (own.empty()) return;
    const auto ends = [&](EdgeId e) { return mesh_.edges[static_cast<std::size_t>(e)]; };
    const auto box = [&](EdgeId e) { return united(boxes_.vertex(ends(e)[0]), boxes_.vertex(ends(e)[1])); };
    MovingBox all;
    for (const EdgeId e : own) all.merge(box(e));
    find_keys(clusters_.edges, boxes_.edges(), all, own.front() + 1, work);
    const auto is_active = [&](EdgeId e) { return boxes_.is_active(ends(e)); };
    match(own, is_active, boxes_.edges(), mesh_.edges, work.keys, work.edges, [&](EdgeId e) {
      const std::size_t begin = first_after(work.edges, e);
      sink_.add_ee(work.pairs, e, find_partners(work.edges, begin, box(e), ends(e), e, work.pairs));
    });
  }

  const Mesh& mesh_;
  const FaceClusters& clusters_;
  const FittedBoxes& boxes_;
  Sink& sink_;
  tbb::enumerable_thread_specific<Workspace> workspaces_;
};

}  // namespace

std::optional<Candidates> find_pairs(const Mesh& mesh, const FaceClusters& clusters, const FittedBoxes& boxes,
                                     std::size_t most) {
  Listing listing(mesh, most);
  PairFinder finder(mesh, clusters, boxes, listing);
  finder.find();
  return listing.take();
}

void visit_pairs(const Mesh& mesh, const FaceClusters& clusters, const FittedBoxes& boxes,
                 const CandidateVisitor& visit) {
  Visiting visiting(visit);
  PairFinder(mesh, clusters, boxes, visiting).find();
  visiting.finish();
}

}  // namespace selvage
