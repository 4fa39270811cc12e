// Whole meshes: the broad phase against brute force (K6), collisions and proximities against the exact checker (K1, K2,
// K4).
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "fuzz/draw/step_world.h"
#include "fuzz/draw/surface_makers.h"
#include "kernel/collisions.h"
#include "kernel/proximities.h"
#include "tests/kernel/random_motion.h"
#include "tests/mutants/drawn_property.h"
#include "tests/mutants/properties.h"
#include "verify/distance_check.h"

namespace selvage::mutants {
namespace {

/// A surface on a lattice or off it, and a motion of any of its vertices; intersections are welcome.
struct MovingMesh {
  Mesh mesh;
  verify::Topology topology;
  std::vector<Positions> x;
  double reach = 0;
};

MovingMesh make_moving_mesh(fuzz::ChoiceSource& source) {
  const auto& classes = fuzz::surface_classes();
  const fuzz::SurfaceDraft draft = classes[source.n(static_cast<std::uint32_t>(classes.size()))].make(source);
  const auto vertex_count = static_cast<std::int32_t>(draft.x.size());
  MovingMesh moving;
  moving.mesh = make_mesh(vertex_count, draft.faces);
  moving.topology = verify::make_topology({draft.faces, {}}, draft.x.size());
  const bool on_lattice = source.coin();
  const int scale = source.one_in(4) ? static_cast<int>(source.zigzag(300)) : 0;
  const double offset = source.one_in(4) ? 0x1p+20 : 0;
  Positions x(vertex_count, 3);
  for (Eigen::Index v = 0; v < x.rows(); ++v) x.row(v) = draft.x[static_cast<std::size_t>(v)];
  for (int frame = 0; frame < 2; ++frame) {
    Positions& placed = moving.x.emplace_back(x);
    for (double& coordinate : placed.reshaped()) {
      if (on_lattice) coordinate = std::floor(4 * coordinate) / 4;
      coordinate = std::ldexp(coordinate + offset, scale);
    }
    const double step = std::ldexp(1.0, -source.range(0, 20));
    for (double& coordinate : x.reshaped()) {
      if (source.coin()) coordinate += on_lattice ? static_cast<double>(source.zigzag(2)) : step * source.signed_real();
    }
  }
  const std::array<double, 5> reaches{0, 0.25, 1, 0x1p-20, draft.gap};
  moving.reach = std::ldexp(reaches[source.n(5)], scale);
  return moving;
}

/// Two motions in a row with one hierarchy.
void prop_candidates_are_those_of_brute_force() {
  const testing::RandomShape shape = testing::random_shape();
  const Mesh mesh = make_mesh(shape.vertex_count, shape.F);
  BoxHierarchy hierarchy(mesh);
  for (int i = 0; i < 2; ++i) {
    const testing::RandomMotion motion = testing::random_motion(shape.vertex_count);
    hierarchy.refit(motion.V_t0, motion.V_t1, motion.options());
    const Candidates expected = find_candidates_brute_force(mesh, motion.V_t0, motion.V_t1, motion.options());
    RC_ASSERT((hierarchy.candidates() == expected));
  }
}

std::optional<Kill> falsify_candidates(std::uint64_t seed, long limit) {
  return first_drawn_failure(seed, limit, prop_candidates_are_those_of_brute_force);
}

using PairName = std::tuple<PairKind, std::int32_t, std::int32_t>;

PairName name_of(const verify::Violation& violation) {
  const PairKind kind = violation.event == verify::EventKind::kVf   ? PairKind::kVf
                        : violation.event == verify::EventKind::kEe ? PairKind::kEe
                                                                    : PairKind::kSelf;
  return {kind, violation.features[0], violation.features[1]};
}

/// Exactly: the pairs nearer than d.
std::set<PairName> near_pairs(const MovingMesh& moving, const Positions& x, double d) {
  std::set<PairName> pairs;
  for (const auto& pair : verify::near_pairs(moving.topology, sim::points_of(x), d)) pairs.insert(name_of(pair));
  return pairs;
}

std::string judge_collisions(std::uint64_t seed) {
  fuzz::ChoiceSource source = fuzz::ChoiceSource::from_seed(seed);
  const MovingMesh moving = make_moving_mesh(source);
  BoxHierarchy hierarchy(moving.mesh);
  const CollisionReport report =
      find_collisions(moving.mesh, hierarchy, moving.x[0], moving.x[1], {.tolerance = moving.reach});
  std::map<PairName, double> found;
  for (const Collision& c : report.collisions) found[{c.kind, c.first, c.second}] = c.ccd.toi_lower;
  verify::CheckOptions options;
  options.max_violations = 1000000;
  const auto motion =
      verify::check_motion(moving.topology, sim::points_of(moving.x[0]), sim::points_of(moving.x[1]), options);
  for (const auto& violation : motion.violations) {
    const auto answer = found.find(name_of(violation));
    if (answer == found.end()) return "missed";
    if (answer->second > violation.t.upper_approx || report.toi_lower > violation.t.upper_approx) return "late-toi";
  }
  for (const PairName& pair : near_pairs(moving, moving.x[1], moving.reach)) {
    if (!found.contains(pair)) return "end-missed";
  }
  return "";
}

std::string judge_proximities(std::uint64_t seed) {
  fuzz::ChoiceSource source = fuzz::ChoiceSource::from_seed(seed);
  const MovingMesh moving = make_moving_mesh(source);
  BoxHierarchy hierarchy(moving.mesh);
  std::set<PairName> found;
  for (const PairProximity& pair : find_proximities(moving.mesh, hierarchy, moving.x[0], moving.reach)) {
    found.insert({pair.kind, pair.first, pair.second});
  }
  for (const PairName& pair : near_pairs(moving, moving.x[0], moving.reach)) {
    if (!found.contains(pair)) return "a pair within reach is not found";
  }
  return "";
}

}  // namespace

std::vector<Property> mesh_properties() {
  return {
      {"candidates", "the broad phase finds what brute force over boxes finds (K6)", falsify_candidates},
      {"collisions", "all that touches on a whole mesh, and all within tolerance at the end, is found in time (K1, K2)",
       falsify<judge_collisions>},
      {"proximities", "all pairs of a mesh that are nearer than the reach are found (K4, K6)",
       falsify<judge_proximities>}};
}

}  // namespace selvage::mutants
