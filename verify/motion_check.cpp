#include <utility>

#include "verify/check.h"
#include "verify/part_trees.h"
#include "verify/violation.h"

namespace selvage::verify {
namespace {

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

const char* kind_name(MotionKind kind) { return kind == MotionKind::kCross ? "cross" : "touch"; }

class MotionCheck {
 public:
  MotionCheck(const Topology& topology, std::span<const Point> V_t0, std::span<const Point> V_t1,
              const CheckOptions& options)
      : topology_(topology),
        V_t0_(V_t0),
        V_t1_(V_t1),
        options_(options),
        tally_(options.max_violations, options.stop) {}

  CheckResult run() {
    check_pairs();
    check_faces(topology_.faces.cloth);
    if (options_.check_bodies) check_faces(topology_.faces.body);
    CheckResult result{tally_.pairs, tally_.violations(), {}, {}, tally_.exempted(), tally_.block_pairs};
    for (const Hit& hit : tally_.first_hits()) result.violations.push_back(timed(hit));
    for (const Hit& hit : tally_.disagreements()) result.disagreements.push_back(timed(hit));
    return result;
  }

 private:
  template <std::size_t N>
  using Vertices = std::array<std::int32_t, N>;

  template <std::size_t N>
  static std::array<Point, N> gather(std::span<const Point> V, const Vertices<N>& vertices) {
    std::array<Point, N> x;
    for (std::size_t i = 0; i < N; ++i) x[i] = V[at(vertices[i])];
    return x;
  }

  template <std::size_t N>
  Boxes<2> boxes(const Vertices<N>& vertices) const {
    return {bounding_box(gather(V_t0_, vertices)), bounding_box(gather(V_t1_, vertices))};
  }

  Vertices<4> vf_vertices(std::int32_t v, std::int32_t f) const {
    const auto& [a, b, c] = topology_.triangles[at(f)];
    return {v, a, b, c};
  }
  Vertices<4> ee_vertices(std::int32_t e, std::int32_t f) const {
    const auto& [a, b] = topology_.edges[at(e)];
    const auto& [c, d] = topology_.edges[at(f)];
    return {a, b, c, d};
  }
  /// A corner of a face, then the edge opposite it.
  Vertices<3> self_vertices(std::int32_t v, std::int32_t f) const {
    return corner_first(topology_.triangles[at(f)], v);
  }

  MotionAnswer ask(EventKind event, std::int32_t i, std::int32_t j, Detail detail) const {
    const auto answer = [&](auto query, const auto& vertices) {
      return query(gather(V_t0_, vertices), gather(V_t1_, vertices), detail);
    };
    if (event == EventKind::kVf) return answer(exact_vf_motion, vf_vertices(i, j));
    if (event == EventKind::kEe) return answer(exact_ee_motion, ee_vertices(i, j));
    return answer(exact_self_motion, self_vertices(i, j));
  }

  void decide(EventKind event, std::int32_t i, std::int32_t j, Tally& tally) const {
    const MotionAnswer answer = ask(event, i, j, Detail::kDecision);
    if (answer.exact_used) ++tally.pairs.exact;
    if (answer.touches) tally.add({event, {i, j}, kind_name(answer.kind)});
    if (asks_again(options_.second_opinion, !answer.exact_used, answer.touches)) {
      tally.add_second_opinion(event, {i, j}, answer.touches, ask_second(event, i, j).touches);
    }
  }

  SecondOpinion ask_second(EventKind event, std::int32_t i, std::int32_t j) const {
    const SecondDeciders& second = options_.second_deciders;
    const auto answer = [&](auto query, const auto& vertices) {
      return query(gather(V_t0_, vertices), gather(V_t1_, vertices));
    };
    if (event == EventKind::kVf) return answer(second.vf, vf_vertices(i, j));
    if (event == EventKind::kEe) return answer(second.ee, ee_vertices(i, j));
    return answer(second.self, self_vertices(i, j));
  }

  void check_pairs() {
    const Lattices<2> lattices{Lattice::over(bulk_box(topology_, V_t0_)), Lattice::over(bulk_box(topology_, V_t1_))};
    const PartTrees<ElementTree<2>> edges(topology_.edge_parts, lattices,
                                          [&](std::int32_t e) { return boxes(topology_.edges[at(e)]); });
    edges.tally_within(options_.check_bodies, options_.max_violations, tally_,
                       [&](Tally& tally, std::int32_t e, std::int32_t f) {
                         if (f < e) std::swap(e, f);
                         const auto [a, b, c, d] = ee_vertices(e, f);
                         if (a == c || a == d || b == c || b == d) return;
                         const std::vector<Label>& labels = topology_.edge_labels;
                         if (tally.is_exempt(topology_, options_.check_bodies, labels, e, labels, f)) return;
                         ++tally.pairs.ee;
                         decide(EventKind::kEe, e, f, tally);
                       });
    const PartTrees<ElementTree<2>> vertices(topology_.vertices, lattices,
                                             [&](std::int32_t v) { return boxes(Vertices<1>{v}); });
    const PartTrees<ElementTree<2>> faces(topology_.faces, lattices,
                                          [&](std::int32_t f) { return boxes(topology_.triangles[at(f)]); });
    vertices.tally_between(
        faces, options_.check_bodies, options_.max_violations, tally_,
        [&](Tally& tally, std::int32_t v, std::int32_t f) {
          const auto& [a, b, c] = topology_.triangles[at(f)];
          if (v == a || v == b || v == c) return;
          if (tally.is_exempt(topology_, options_.check_bodies, topology_.vertex_labels, v, topology_.face_labels, f)) {
            return;
          }
          ++tally.pairs.vf;
          decide(EventKind::kVf, v, f, tally);
        });
  }

  void check_faces(const std::vector<std::int32_t>& faces) {
    tally_in_parallel(faces.size(), options_.max_violations, tally_, [&](std::size_t i, Tally& tally) {
      for (const std::int32_t v : topology_.triangles[at(faces[i])]) {
        ++tally.pairs.self;
        decide(EventKind::kSelf, v, faces[i], tally);
      }
    });
  }

  Violation timed(const Hit& hit) const {
    Violation violation = describe(topology_, hit);
    violation.motion = true;
    violation.t = ask(hit.event, hit.features[0], hit.features[1], Detail::kFirstTime).first;
    set_positions(violation, V_t0_, V_t1_);
    return violation;
  }

  const Topology& topology_;
  std::span<const Point> V_t0_, V_t1_;
  const CheckOptions& options_;
  Tally tally_;
};

}  // namespace

CheckResult check_motion(const Topology& topology, std::span<const Point> V_t0, std::span<const Point> V_t1,
                         const CheckOptions& options) {
  const FpGuard guard;
  require_positions(topology, V_t0);
  require_positions(topology, V_t1);
  return MotionCheck(topology, V_t0, V_t1, options).run();
}

CheckResult check_motion(const Surface& surface, std::span<const Point> V_t0, std::span<const Point> V_t1,
                         const CheckOptions& options) {
  return check_motion(make_topology(surface, V_t0.size()), V_t0, V_t1, options);
}

}  // namespace selvage::verify
