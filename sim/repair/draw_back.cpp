#include "sim/repair/draw_back.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <Eigen/Geometry>

#include "kernel/collisions.h"
#include "sim/base/disjoint_sets.h"
#include "sim/base/sorted_once.h"
#include "sim/repair/flat_layout.h"
#include "sim/repair/spanning_membrane.h"

namespace selvage::sim {
namespace {

constexpr int kShapeHalvings = 12;  // of the shape that is kept: 2^-12 of a hand is thinner than cloth

constexpr std::size_t kMaxMet = 100'000;  // pairs with bodies that meet on a way: chosen; more say no more

/// By which a region may grow, where the ring around it is too near.
struct GrowthRings {
  int first, last;
};
// Of 38 single cloths that near rings left as they were, curled into themselves, folded or crumpled, far ones freed 20
// of 32 tried, and laid flat 37 of 38 are. So flat comes first: it moved curls and folded corners by 0.14 m at most,
// with strains below a tenth, where far rings moved them by up to 0.85 m, in 63 s. Of 69 curls and corners with a
// vertex pinned, which are not laid flat, near rings free 31 and far ones 64.
constexpr GrowthRings kNearRings{0, 3}, kFarRings{4, 12};
// Drawing back ends here, so that rounds remain to lay a part flat: a crumple of a thousand vertices uses all of them,
// as it gains a pair or two a round; 2 of 10 are free with them alone. Of 800 tangles none was freed by drawing back
// later.
constexpr std::int32_t kLastDrawRound = kMaxUntangleRounds - 40;

class ClothUntangler {
 public:
  explicit ClothUntangler(UntangleState& state) : state_(state), mesh_(state.mesh), neighbours_(neighbours_of(mesh_)) {
    for (VertexId v = 0; v < mesh_.vertex_count; ++v) is_of_body_.push_back(state.is_body(v) ? 1 : 0);
  }

  bool run() {
    pairs_ = judge(state_.x);
    while (!pairs_.empty() && improve()) {
    }
    return pairs_.empty();
  }

 private:
  [[nodiscard]] std::vector<FacePair> judge(const Positions& at) { return state_.only(state_.judge(at), false); }
  [[nodiscard]] const std::array<VertexId, 3>& face(FaceId f) const { return mesh_.faces[static_cast<std::size_t>(f)]; }
  [[nodiscard]] VertexId part_of(FaceId f) const { return state_.parts.part(face(f)[0]); }
  [[nodiscard]] Vec3 at(VertexId v) const { return state_.x.row(v); }
  [[nodiscard]] double farthest() const {
    return 2 * (state_.x.colwise().maxCoeff() - state_.x.colwise().minCoeff()).stableNorm();
  }
  [[nodiscard]] std::vector<std::uint8_t> cut_edges() const;
  [[nodiscard]] std::vector<Region> regions() const;
  void grow(Region& region) const;
  void drop_what_has_no_ring(Region& region) const;
  [[nodiscard]] std::vector<Region> crossings() const;
  bool improve() {
    way_through_.reset();
    return move_a_part() || draw_one_back(kNearRings) || go_through() || flatten_a_part() || draw_one_back(kFarRings) ||
           go_through();
  }
  bool draw_back(Region region, const GrowthRings& rings);
  bool draw_one_back(const GrowthRings& rings) {
    const auto back = [&](const Region& region) { return draw_back(region, rings); };
    return std::ranges::any_of(regions(), back) || std::ranges::any_of(crossings(), back);
  }
  bool go_through() {
    if (!way_through_) return false;
    keep(*way_through_);
    return true;
  }
  bool move_a_part();
  bool flatten_a_part();
  bool flatten(const Region& part);
  /// Off the plane of what is laid flat: nowhere, and to both sides as far as needed, where there is anything else.
  [[nodiscard]] std::vector<double> shifts_aside(const Region& part) const;
  /// Whether cloth meets a body on its straight way to x: it may end on its other side.
  [[nodiscard]] bool passes_a_body(const Positions& x);
  struct Better {
    Positions x;
    std::vector<FacePair> pairs;
  };
  void keep(Better& better) {
    pairs_ = std::move(better.pairs);
    state_.x = std::move(better.x);
  }
  /// Keeps the positions where fewer pairs intersect, none that must end, and no body lies in the way.
  bool keep_if_better(const Positions& x, const std::function<bool(const FacePair&)>& must_end = {});

  UntangleState& state_;
  const Mesh& mesh_;
  Neighbours neighbours_;
  std::vector<FacePair> pairs_;  ///< at state_.x
  BoxHierarchy hierarchy_{mesh_};
  std::vector<std::uint8_t> is_of_body_;  ///< #V
  std::optional<Better> way_through_;     ///< a body: taken where nothing else helps
};

double volume(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) { return (b - a).cross(c - a).dot(d - a); }

/// In doubles: what is nearly so may be called either way, and only chooses what is tried.
bool crosses(const Vec3& a, const Vec3& b, const std::array<Vec3, 3>& t) {
  const double at_a = volume(t[0], t[1], t[2], a), at_b = volume(t[0], t[1], t[2], b);
  if (at_a == at_b || (at_a > 0) == (at_b > 0)) return false;
  const double u = volume(a, b, t[0], t[1]), v = volume(a, b, t[1], t[2]), w = volume(a, b, t[2], t[0]);
  return (u >= 0 && v >= 0 && w >= 0) || (u <= 0 && v <= 0 && w <= 0);
}

std::vector<std::uint8_t> ClothUntangler::cut_edges() const {
  std::vector<std::uint8_t> cut(mesh_.edges.size(), 0);
  for (const FacePair& pair : pairs_) {
    for (const std::size_t side : {0U, 1U}) {
      const auto& other = face(pair[1 - side]);
      for (const EdgeId e : mesh_.face_edges[static_cast<std::size_t>(pair[side])]) {
        const auto& edge = mesh_.edges[static_cast<std::size_t>(e)];
        if (std::ranges::any_of(other, [&](VertexId v) { return v == edge[0] || v == edge[1]; })) continue;
        if (crosses(at(edge[0]), at(edge[1]), {at(other[0]), at(other[1]), at(other[2])})) {
          cut[static_cast<std::size_t>(e)] = 1;
        }
      }
    }
  }
  return cut;
}

/// Those at a cut that no script holds, the smallest first, without the largest of each part.
std::vector<Region> ClothUntangler::regions() const {
  const std::vector<std::uint8_t> cut = cut_edges();
  DisjointSets<VertexId> uncut(mesh_.vertex_count);
  for (std::size_t e = 0; e < cut.size(); ++e) {
    if (cut[e] == 0) uncut.join(mesh_.edges[e][0], mesh_.edges[e][1]);
  }
  std::map<VertexId, Region> by_root;
  for (VertexId v = 0; v < mesh_.vertex_count; ++v) {
    if (!state_.is_body(v)) by_root[uncut.root(v)].push_back(v);
  }
  std::map<VertexId, std::size_t> largest;
  for (const auto& [root, region] : by_root) {
    std::size_t& size = largest[state_.parts.part(root)];
    size = std::max(size, region.size());
  }
  std::vector<Region> result;
  for (auto& [root, region] : by_root) {
    const bool has_script = std::ranges::any_of(region, [&](VertexId v) { return state_.is_scripted(v); });
    if (region.size() < largest[state_.parts.part(root)] && !has_script) result.push_back(std::move(region));
  }
  std::ranges::stable_sort(result, {}, &Region::size);
  return result;
}

void ClothUntangler::grow(Region& region) const {
  Region grown = region;
  for (const VertexId v : region) {
    const auto& around = neighbours_[static_cast<std::size_t>(v)];
    grown.insert(grown.end(), around.begin(), around.end());
  }
  keep_sorted_once(grown);
  region = std::move(grown);
}

/// A whole part that nothing holds, say: its membrane could be anywhere, and its Laplacian is singular.
void ClothUntangler::drop_what_has_no_ring(Region& region) const {
  const std::size_t ring = region.size();
  DisjointSets<std::size_t> together(ring + 1);
  for (std::size_t i = 0; i < ring; ++i) {
    for (const VertexId v : neighbours_[static_cast<std::size_t>(region[i])]) together.join(i, index_in(region, v));
  }
  Region kept;
  for (std::size_t i = 0; i < ring; ++i) {
    if (together.root(i) == together.root(ring)) kept.push_back(region[i]);
  }
  region = std::move(kept);
}

bool ClothUntangler::keep_if_better(const Positions& x, const std::function<bool(const FacePair&)>& must_end) {
  if (!(x.array().abs() <= kMaxCoordinate).all() || !state_.may_judge()) return false;
  std::vector<FacePair> pairs = judge(x);
  if (pairs.size() >= pairs_.size() || (must_end && std::ranges::any_of(pairs, must_end))) return false;
  Better better{x, std::move(pairs)};
  if (passes_a_body(x)) {
    if (!way_through_) way_through_ = std::move(better);
    return false;
  }
  keep(better);
  return true;
}

bool ClothUntangler::passes_a_body(const Positions& x) {
  if (std::ranges::find(is_of_body_, 1) == is_of_body_.end()) return false;
  const CollisionLimits limits{.most_collisions = kMaxMet};
  const CollisionReport met = find_collisions(mesh_, hierarchy_, state_.x, x, {.tolerance = 0}, is_of_body_, limits);
  return !met.is_complete || std::ranges::any_of(met.collisions, [&](const Collision& collision) {
    const auto vertices = pair_vertices(mesh_, collision.kind, collision.first, collision.second);
    return std::ranges::any_of(vertices, [&](VertexId v) { return !state_.is_body(v); });
  });
}

bool ClothUntangler::draw_back(Region region, const GrowthRings& rings) {
  for (int growth = 0; growth <= rings.last; ++growth, grow(region)) {
    std::erase_if(region, [&](VertexId v) { return state_.is_scripted(v); });
    drop_what_has_no_ring(region);
    if (region.empty()) return false;
    if (growth < rings.first) continue;
    const std::optional<Positions> flat = spanning_membrane(neighbours_, region, state_.x);
    if (!flat) return false;
    for (int halvings = 1; halvings <= kShapeHalvings; ++halvings) {
      if (state_.rounds >= kLastDrawRound) return false;
      Positions x = state_.x;
      for (std::size_t i = 0; i < region.size(); ++i) {
        const Vec3 target = flat->row(static_cast<Eigen::Index>(i)), here = at(region[i]);
        x.row(region[i]) = state_.on_lattice(target + std::ldexp(1.0, -halvings) * (here - target));
      }
      if (keep_if_better(x)) return true;
    }
  }
  return false;
}

/// What hangs together by crossing and by common vertices; the smallest first.
std::vector<Region> ClothUntangler::crossings() const {
  DisjointSets<VertexId> together(mesh_.vertex_count);
  std::vector<std::uint8_t> is_in(static_cast<std::size_t>(mesh_.vertex_count), 0);
  for (const FacePair& pair : pairs_) {
    for (const FaceId f : pair) {
      for (const VertexId v : face(f)) {
        together.join(face(pair[0])[0], v);
        is_in[static_cast<std::size_t>(v)] = 1;
      }
    }
  }
  std::map<VertexId, Region> by_root;
  for (VertexId v = 0; v < mesh_.vertex_count; ++v) {
    if (is_in[static_cast<std::size_t>(v)] != 0) by_root[together.root(v)].push_back(v);
  }
  std::vector<Region> result;
  for (auto& [root, region] : by_root) result.push_back(std::move(region));
  std::ranges::stable_sort(result, {}, &Region::size);
  return result;
}

bool ClothUntangler::move_a_part() {
  std::map<VertexId, Vec3> normal_of;  // by part: the sum of the unit normals of the others' faces that it meets
  for (const FacePair& pair : pairs_) {
    if (part_of(pair[0]) == part_of(pair[1])) continue;
    for (const std::size_t side : {0U, 1U}) {
      const auto& other = face(pair[1 - side]);
      const Vec3 normal = (at(other[1]) - at(other[0])).cross(at(other[2]) - at(other[0])).stableNormalized();
      normal_of.try_emplace(part_of(pair[side]), Vec3::Zero()).first->second += normal;
    }
  }
  std::erase_if(normal_of, [&](const auto& entry) {
    bool has_script = false;
    for (VertexId v = 0; v < mesh_.vertex_count; ++v) {
      has_script = has_script || (state_.is_scripted(v) && state_.parts.part(v) == entry.first);
    }
    return has_script;
  });
  for (double distance = state_.options.gap_m; distance <= farthest(); distance *= 2) {
    for (const auto& [part, normal_sum] : normal_of) {
      const auto meets_another = [this, moved = part](const FacePair& p) {
        return part_of(p[0]) != part_of(p[1]) && (part_of(p[0]) == moved || part_of(p[1]) == moved);
      };
      for (const double side : {1.0, -1.0}) {
        const Vec3 shift = side * distance * normal_sum.stableNormalized();
        Positions x = state_.x;
        for (VertexId v = 0; v < mesh_.vertex_count; ++v) {
          if (state_.parts.part(v) == part) x.row(v) = state_.on_lattice(at(v) + shift);
        }
        if (keep_if_better(x, meets_another)) return true;
      }
    }
  }
  return false;
}

bool ClothUntangler::flatten_a_part() {
  std::map<VertexId, Region> crossed;
  for (const FacePair& pair : pairs_) {
    for (const FaceId f : pair) crossed[part_of(f)];
  }
  for (VertexId v = 0; v < mesh_.vertex_count; ++v) {
    const auto found = crossed.find(state_.parts.part(v));
    if (found != crossed.end()) found->second.push_back(v);
  }
  return std::ranges::any_of(crossed, [this](const auto& entry) { return flatten(entry.second); });
}

bool ClothUntangler::flatten(const Region& part) {
  if (std::ranges::any_of(part, [this](VertexId v) { return state_.is_scripted(v); })) return false;
  const std::optional<FlatLayout> flat = flat_layout(mesh_, neighbours_, part, state_.V, state_.x);
  if (!flat) return false;
  const auto is_within = [this, of = state_.parts.part(part.front())](const FacePair& p) {
    return part_of(p[0]) == of && part_of(p[1]) == of;
  };
  for (const double shift : shifts_aside(part)) {
    for (int halvings = 1; halvings <= kShapeHalvings + 1; ++halvings) {
      const double kept = halvings > kShapeHalvings ? 0 : std::ldexp(1.0, -halvings);
      Positions x = state_.x;
      for (std::size_t i = 0; i < part.size(); ++i) {
        const Vec3 target = flat->x.row(static_cast<Eigen::Index>(i));
        x.row(part[i]) = state_.on_lattice(target + kept * (at(part[i]) - target) + shift * flat->across);
      }
      if (keep_if_better(x, is_within)) return true;
    }
  }
  return false;
}

std::vector<double> ClothUntangler::shifts_aside(const Region& part) const {
  std::vector<double> shifts{0};
  if (part.size() == state_.is_cloth.size()) return shifts;
  for (double distance = state_.options.gap_m; distance <= farthest(); distance *= 4) {
    shifts.insert(shifts.end(), {distance, -distance});
  }
  return shifts;
}

}  // namespace

bool draw_cloth_back(UntangleState& state) { return ClothUntangler(state).run(); }

}  // namespace selvage::sim
