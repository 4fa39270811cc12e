// Queries as cloth really asks them: candidate pairs from the steps of a small simulation.
#include <cmath>

#include "fuzz/draw/query_makers.h"
#include "kernel/box_hierarchy.h"
#include "sim/scene/scene_reader.h"
#include "sim/step.h"

namespace selvage::fuzz::make {
namespace {

// A sheet falls over a post onto a ground: contact with bodies and, folded, with itself. No rotation and no
// trigonometry, so that every machine records the same bits.
constexpr std::string_view kScene = R"(
gravity_m_s2 = [0, 0, -9.81]
drag_1_s = 0.3
[time]
frames_per_s = 30
frames = 24
min_step_s = 0.008
[collision]
thickness_m = 0.004
friction_static = 0.4
[[cloth]]
sheet = {nx = 12, ny = 12, width_m = 0.6, height_m = 0.6}
position_m = [0, 0, 0.31]
velocity_m_s = [0, 0, -1]
density_kg_m2 = 0.2
stretch_n_m = 20
shear_n_m = 6
damping_ratio = 0.1
[[body]]
name = "post"
box = {size_m = [0.04, 0.04, 0.3]}
position_m = [0.013, 0.007, 0.15]
[[body]]
name = "ground"
sheet = {nx = 2, ny = 2, width_m = 3, height_m = 3}
position_m = [0.1, 0, -0.01]
)";

struct Recording {
  std::array<std::vector<MotionQuery>, 2> queries;  ///< by PairKind: vf, ee
};

MotionQuery query_of(PairKind kind, const std::array<VertexId, 4>& vertices, const Positions& x_t0,
                     const Positions& x_t1) {
  MotionQuery query;
  query.kind = kind;
  for (std::size_t i = 0; i < 4; ++i) {
    query.x_t0[i] = x_t0.row(vertices[i]);
    query.x_t1[i] = x_t1.row(vertices[i]);
  }
  return query;
}

/// Every so many of a step's candidates: neighbours in the list are much alike.
constexpr std::size_t kStride = 7;

Recording record() {
  const sim::Scene scene = sim::parse_scene(kScene, "the recorded scene");
  sim::Simulation simulation(scene);
  Recording recording;
  while (simulation.clock().frame() < scene.time.frame_count) {
    const Positions x_t0 = simulation.x();
    (void)simulation.step();
    const Mesh& mesh = simulation.world().mesh;
    BoxHierarchy hierarchy(mesh);
    hierarchy.refit(x_t0, simulation.x(), {.reach = scene.collision.thickness_m, .active = {}});
    const Candidates candidates = hierarchy.candidates();
    const auto keep = [&](PairKind kind, const auto& pairs) {
      for (std::size_t i = 0; i < pairs.size(); i += kStride) {
        recording.queries[static_cast<std::size_t>(kind)].push_back(
            query_of(kind, pair_vertices(mesh, pairs[i]), x_t0, simulation.x()));
      }
    };
    keep(PairKind::kVf, candidates.vf);
    keep(PairKind::kEe, candidates.ee);
  }
  return recording;
}

}  // namespace

MotionQuery recorded(ChoiceSource& source, PairKind kind) {
  static const Recording recording = record();
  const std::vector<MotionQuery>& queries = recording.queries[static_cast<std::size_t>(kind)];
  MotionQuery query = queries[source.n(static_cast<std::uint32_t>(queries.size()))];
  // The step ended free of touch; continued, or left out the response that prevented it, it need not.
  if (source.coin()) {
    const double factor = std::ldexp(1.0, source.range(0, 6));
    for (std::size_t i = 0; i < 4; ++i) query.x_t1[i] = query.x_t0[i] + factor * (query.x_t1[i] - query.x_t0[i]);
  }
  if (source.coin()) nudge(source, query, 1);
  return query;
}

}  // namespace selvage::fuzz::make
