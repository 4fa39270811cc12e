// After some vertices have moved, detection among the pairs with a moved vertex and the old results of the others are
// what detection from scratch finds: bit by bit, for candidates, collisions and proximities. But for pairs that one of
// the calls proves apart and the query of the pair alone does not: whether they are left out depends on the whole mesh.
#include <cstring>

#include <gtest/gtest.h>

#include "kernel/collisions.h"
#include "kernel/proximities.h"
#include "tests/kernel/left_out.h"
#include "tests/kernel/random_motion.h"
#include "tests/kernel/with_threads.h"
#include "tests/property.h"

namespace selvage {

namespace {

/// What the incremental detection starts from and what it comes to.
struct Change {
  Mesh mesh;
  testing::RandomMotion before;
  Positions V_t0, V_t1;             ///< after
  std::vector<std::uint8_t> moved;  ///< superset of the rows that differ
};

Change random_change() {
  const auto shape = testing::random_shape();
  Change change = {make_mesh(shape.vertex_count, shape.F), testing::random_motion(shape.vertex_count), {}, {}, {}};
  change.before.active.clear();
  const auto after = testing::random_motion(shape.vertex_count);
  change.V_t0 = change.before.V_t0;
  change.V_t1 = change.before.V_t1;
  const bool both_ends = *rc::gen::arbitrary<bool>();
  const int one_in = *rc::gen::element(1, 2, 8, 64);
  for (Eigen::Index v = 0; v < change.V_t0.rows(); ++v) {
    const bool moves = *rc::gen::inRange(0, one_in) == 0;
    change.moved.push_back(moves ? 1 : 0);
    if (!moves) continue;
    change.V_t1.row(v) = after.V_t1.row(v);
    if (both_ends) change.V_t0.row(v) = after.V_t0.row(v);
  }
  RC_LOG() << shape << "\nbefore " << change.before << "\nafter " << after << '\n';
  return change;
}

template <typename Pair>
bool has_moved(const Change& change, const Pair& pair) {
  const auto vertices = pair_vertices(change.mesh, pair.kind, pair.first, pair.second);
  return std::any_of(vertices.begin(), vertices.end(),
                     [&](VertexId v) { return change.moved[static_cast<std::size_t>(v)] != 0; });
}

/// `old` without the pairs that have a moved vertex, and `found`, in order.
template <typename Pair>
std::vector<Pair> updated(const Change& change, const std::vector<Pair>& old, const std::vector<Pair>& found) {
  std::vector<Pair> all;
  std::copy_if(old.begin(), old.end(), std::back_inserter(all), [&](const Pair& p) { return !has_moved(change, p); });
  all.insert(all.end(), found.begin(), found.end());
  std::sort(all.begin(), all.end(), [](const Pair& a, const Pair& b) {
    return std::tie(a.kind, a.first, a.second) < std::tie(b.kind, b.first, b.second);
  });
  return all;
}

struct PlainPair {
  PairKind kind;
  std::int32_t first, second;
  friend bool operator==(const PlainPair&, const PlainPair&) = default;
};

std::vector<PlainPair> plain(const Candidates& candidates) {
  std::vector<PlainPair> pairs;
  for (const auto& [v, f] : candidates.vf) pairs.push_back({PairKind::kVf, v, f});
  for (const auto& [a, b] : candidates.ee) pairs.push_back({PairKind::kEe, a, b});
  return pairs;
}

template <std::size_t N>
bool same_bits(const double* a, const double* b) {
  return std::memcmp(a, b, N * sizeof(double)) == 0;
}

bool same(const Collision& a, const Collision& b) {
  return a.kind == b.kind && a.first == b.first && a.second == b.second && a.ccd.verdict == b.ccd.verdict &&
         a.ccd.cause == b.ccd.cause && a.ccd.intervals == b.ccd.intervals &&
         same_bits<1>(&a.ccd.toi_lower, &b.ccd.toi_lower) && same_bits<1>(&a.ccd.gap_bound, &b.ccd.gap_bound) &&
         same_bits<4>(a.ccd.weights.data(), b.ccd.weights.data()) &&
         same_bits<3>(a.ccd.normal.data(), b.ccd.normal.data());
}

bool same(const PairProximity& a, const PairProximity& b) {
  const Proximity &x = a.proximity, &y = b.proximity;
  return a.kind == b.kind && a.first == b.first && a.second == b.second && a.vertices == b.vertices &&
         same_bits<1>(&x.distance, &y.distance) && same_bits<1>(&x.distance_lower, &y.distance_lower) &&
         same_bits<1>(&x.distance_upper, &y.distance_upper) && same_bits<4>(x.weights.data(), y.weights.data()) &&
         same_bits<3>(x.normal.data(), y.normal.data()) && same_bits<1>(&x.point_error_bound, &y.point_error_bound);
}

/// `a` without those pairs that `b` lacks and a call may leave out.
template <typename Pair, typename MayBeLeftOut>
std::vector<Pair> without_left_out(const std::vector<Pair>& a, const std::vector<Pair>& b,
                                   const MayBeLeftOut& may_be_left_out) {
  const auto name = [](const Pair& pair) { return std::tuple(pair.kind, pair.first, pair.second); };
  std::vector<Pair> kept;
  std::ranges::copy_if(a, std::back_inserter(kept), [&](const Pair& pair) {
    return std::ranges::binary_search(b, name(pair), {}, name) || !may_be_left_out(pair);
  });
  return kept;
}

double first_toi_lower(const std::vector<Collision>& collisions) {
  double toi_lower = 1;
  for (const Collision& collision : collisions) toi_lower = std::min(toi_lower, collision.ccd.toi_lower);
  return toi_lower;
}

template <typename Pair, typename MayBeLeftOut>
bool same(const std::vector<Pair>& a, const std::vector<Pair>& b, const MayBeLeftOut& may_be_left_out) {
  return std::ranges::equal(without_left_out(a, b, may_be_left_out), without_left_out(b, a, may_be_left_out),
                            [](const Pair& x, const Pair& y) { return same(x, y); });
}

HierarchyKind random_kind() {
  return *rc::gen::element(HierarchyKind::kAutomatic, HierarchyKind::kSpatial, HierarchyKind::kTopology);
}

}  // namespace

TEST(Incremental, PropCandidatesOfMovedVerticesCompleteTheOldOnes) {
  testing::check_property(500, 31, [] {
    const Change change = random_change();
    const double reach = change.before.reach;
    BoxHierarchy hierarchy(change.mesh, random_kind());
    hierarchy.refit(change.before.V_t0, change.before.V_t1, {reach, {}});
    const auto old = plain(hierarchy.candidates());
    hierarchy.refit(change.V_t0, change.V_t1, {reach, change.moved});
    const auto found = plain(hierarchy.candidates());
    hierarchy.refit(change.V_t0, change.V_t1, {reach, {}});
    RC_ASSERT(updated(change, old, found) == plain(hierarchy.candidates()));
  });
}

TEST(Incremental, PropCollisionsOfMovedVerticesCompleteTheOldOnes) {
  testing::check_property(100, 32, [] {
    const Change change = random_change();
    const CcdOptions options = {change.before.reach, 8};  // few intervals: what is compared is the set, not the depth
    BoxHierarchy hierarchy(change.mesh, random_kind());
    testing::with_threads(*rc::gen::element(1, 2, 8), [&] {
      const auto old = find_collisions(change.mesh, hierarchy, change.before.V_t0, change.before.V_t1, options);
      const auto found = find_collisions(change.mesh, hierarchy, change.V_t0, change.V_t1, options, change.moved);
      const auto full = find_collisions(change.mesh, hierarchy, change.V_t0, change.V_t1, options);
      const auto completed = updated(change, old.collisions, found.collisions);
      RC_ASSERT(same(completed, full.collisions, [&](const Collision& pair) {
        return testing::may_be_left_out(change.mesh, change.V_t0, change.V_t1, pair, options.tolerance);
      }));
      RC_ASSERT(full.toi_lower == first_toi_lower(full.collisions));
      RC_ASSERT(found.toi_lower == first_toi_lower(found.collisions));
    });
  });
}

TEST(Incremental, PropProximitiesOfMovedVerticesCompleteTheOldOnes) {
  testing::check_property(400, 33, [] {
    const Change change = random_change();
    const double reach = change.before.reach;
    BoxHierarchy hierarchy(change.mesh, random_kind());
    const auto old = find_proximities(change.mesh, hierarchy, change.before.V_t1, reach);
    const auto found = find_proximities(change.mesh, hierarchy, change.V_t1, reach, change.moved);
    const auto full = find_proximities(change.mesh, hierarchy, change.V_t1, reach);
    RC_ASSERT(same(updated(change, old, found), full,
                   [&](const PairProximity& pair) { return pair.proximity.distance_upper >= reach; }));
  });
}

}  // namespace selvage
