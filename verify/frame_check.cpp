#include <utility>

#include "verify/arithmetic/predicates.h"
#include "verify/check.h"
#include "verify/decision/exact_overlap.h"
#include "verify/distance_check.h"
#include "verify/first_violations.h"
#include "verify/part_trees.h"
#include "verify/search/face_tree.h"
#include "verify/violation.h"

namespace selvage::verify {
namespace {

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

class FrameCheck {
 public:
  FrameCheck(const Topology& topology, std::span<const Point> V, const CheckOptions& options, const Tally& tally)
      : topology_(topology), V_(V), options_(options), tally_(tally) {}

  CheckResult run() {
    const FloatFrame frame = FloatFrame::over(bulk_box(topology_, V_));
    const PartTrees<FaceTree> faces(topology_.faces, topology_.triangles, V_, frame);
    const bool each = !topology_.exemptions.empty() || options_.second_opinion == SecondOpinionScope::kAll;
    faces.tally_within(options_.check_bodies, options_.max_violations, tally_, FoundPairs{*this}, each);
    check_areas(topology_.faces.cloth);
    if (options_.check_bodies) check_areas(topology_.faces.body);
    if (options_.min_distance) check_distances(topology_, V_, *options_.min_distance, options_, tally_);
    return result();
  }

 private:
  std::array<Point, 3> corners(std::int32_t face) const {
    const auto& [a, b, c] = topology_.triangles[at(face)];
    return {V_[at(a)], V_[at(b)], V_[at(c)]};
  }

  /// What the trees find: pairs that are apart, by number or one by one, and pairs that nothing is known about.
  struct FoundPairs {
    const FrameCheck& check;
    void operator()(Tally& tally, std::int64_t apart_count) const { tally.pairs.overlap += apart_count; }
    void operator()(Tally& tally, std::int32_t f, std::int32_t g, bool apart) const {
      const Topology& topology = check.topology_;
      if (tally.is_exempt(topology, check.options_.check_bodies, topology.face_labels, f, topology.face_labels, g))
        return;
      ++tally.pairs.overlap;
      if (!apart) {
        check.check_pair(f, g, tally);
      } else if (asks_again(check.options_.second_opinion, true, false)) {
        check.ask_again(std::min(f, g), std::max(f, g), false, tally);
      }
    }
  };

  void check_pair(std::int32_t f, std::int32_t g, Tally& tally) const {
    if (g < f) std::swap(f, g);
    const OverlapAnswer answer =
        exact_overlap(topology_.triangles[at(f)], corners(f), topology_.triangles[at(g)], corners(g));
    if (answer.exact_used) ++tally.pairs.exact;
    const bool touches = answer.kind != OverlapKind::kNone;
    if (touches) tally.add({EventKind::kOverlap, {f, g}, name_of(answer.kind)});
    if (asks_again(options_.second_opinion, !answer.exact_used, touches)) ask_again(f, g, touches, tally);
  }

  void ask_again(std::int32_t f, std::int32_t g, bool touches, Tally& tally) const {
    const bool second = options_.second_deciders.overlap(topology_.triangles[at(f)], corners(f),
                                                         topology_.triangles[at(g)], corners(g));
    tally.add_second_opinion(EventKind::kOverlap, {f, g}, touches, second);
  }

  /// The corner that lies between the other two: of three collinear points one does.
  std::int32_t middle_corner(std::int32_t face) const {
    const auto x = corners(face);
    for (std::size_t i = 0; i < 3; ++i) {
      const Box others = bounding_box(std::array<Point, 2>{x[(i + 1) % 3], x[(i + 2) % 3]});
      if (others.overlaps({x[i], x[i]})) return topology_.triangles[at(face)][i];
    }
    return topology_.triangles[at(face)][0];
  }

  void check_areas(const std::vector<std::int32_t>& faces) {
    tally_in_parallel(faces.size(), options_.max_violations, tally_, [&](std::size_t i, Tally& tally) {
      ++tally.pairs.self;
      const std::array<Point, 3> x = corners(faces[i]);
      const auto [degenerate, exact_used] = exact_degenerate(x);
      if (exact_used) ++tally.pairs.exact;
      if (asks_again(options_.second_opinion, !exact_used, degenerate)) {
        tally.add_second_opinion(EventKind::kSelf, {middle_corner(faces[i]), faces[i]}, degenerate,
                                 options_.second_deciders.degenerate(x));
      }
      if (degenerate) tally.add({EventKind::kSelf, {middle_corner(faces[i]), faces[i]}, "degenerate"});
    });
  }

  Violation placed(const Hit& hit) const {
    Violation violation = describe(topology_, hit);
    set_positions(violation, V_, V_);
    return violation;
  }

  CheckResult result() const {
    CheckResult result{tally_.pairs, tally_.violations(), {}, {}, tally_.exempted(), tally_.block_pairs};
    for (const Hit& hit : tally_.first_hits()) result.violations.push_back(placed(hit));
    for (const Hit& hit : tally_.disagreements()) result.disagreements.push_back(placed(hit));
    return result;
  }

  const Topology& topology_;
  std::span<const Point> V_;
  const CheckOptions& options_;
  Tally tally_;
};

}  // namespace

CheckResult check_frame(const Topology& topology, std::span<const Point> V, const CheckOptions& options) {
  const FpGuard guard;
  require_positions(topology, V);
  return FrameCheck(topology, V, options, Tally(options.max_violations, options.stop)).run();
}

CheckResult check_frame(const Surface& surface, std::span<const Point> V, const CheckOptions& options) {
  return check_frame(make_topology(surface, V.size()), V, options);
}

std::vector<Violation> first_violations(const Topology& topology, std::span<const Point> V, std::size_t enough,
                                        CheckOptions options) {
  const FpGuard guard;
  require_positions(topology, V);
  options.max_violations = enough;
  return FrameCheck(topology, V, options, Tally::of_first(enough, options.stop)).run().violations;
}

}  // namespace selvage::verify
