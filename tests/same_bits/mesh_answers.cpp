#include <cmath>

#include "tests/kernel/random_points.h"
#include "tests/same_bits/hash.h"

namespace selvage::testing {

namespace {

struct MeshCase {
  Mesh mesh;
  Positions V_t0, V_t1;
  double size;  ///< of an edge
};

/// A pleated, roughened sheet of side by side squares that moves by up to an edge.
MeshCase pleated_sheet(int side, int exponent, std::uint64_t seed) {
  Random random(seed);
  const int stride = side + 1;
  Positions V_t0(stride * stride, 3), V_t1(stride * stride, 3);
  for (int i = 0; i < stride; ++i) {
    for (int j = 0; j < stride; ++j) {
      const int phase = i % 8, height = phase < 4 ? phase : 8 - phase;
      const Vec3 rough = detail::to_vec3(random.point()), motion = detail::to_vec3(random.point());
      const Vec3 x = Vec3(0.25 * i, j, height) + 0.0625 * rough;
      V_t0.row(i * stride + j) = std::ldexp(1.0, exponent) * x;
      V_t1.row(i * stride + j) = std::ldexp(1.0, exponent) * (x + 0.5 * motion);
    }
  }
  Faces F(2 * side * side, 3);
  for (int i = 0; i < side; ++i) {
    for (int j = 0; j < side; ++j) {
      const int corner = i * stride + j, face = 2 * (i * side + j);
      F.row(face) << corner, corner + stride, corner + 1;
      F.row(face + 1) << corner + stride + 1, corner + 1, corner + stride;
    }
  }
  return {make_mesh(stride * stride, F), V_t0, V_t1, std::ldexp(1.0, exponent)};
}

void add(Hash& hash, const Candidates& candidates) {
  for (const auto& [v, f] : candidates.vf) hash.add(std::int64_t{v} << 32 | f);
  for (const auto& [a, b] : candidates.ee) hash.add(std::int64_t{a} << 32 | b);
}

void add(Hash& hash, const BatchReport& report) {
  for (const auto& [candidate, ccd] : report.answers) {
    hash.add(static_cast<std::int64_t>(candidate));
    hash.add(ccd);
  }
  hash.add(report.searched);
  hash.add(report.intervals);
}

void add(Hash& hash, const CollisionReport& report) {
  for (const Collision& collision : report.collisions) {
    hash.add(static_cast<std::int64_t>(collision.kind));
    hash.add(collision.first);
    hash.add(collision.second);
    hash.add(collision.ccd);
  }
  hash.add(report.toi_lower);
  for (const std::int64_t count :
       {report.vf_candidates, report.ee_candidates, report.self_candidates, report.intervals}) {
    hash.add(count);
  }
}

void add(Hash& hash, const std::vector<PairProximity>& proximities) {
  for (const PairProximity& pair : proximities) {
    hash.add(static_cast<std::int64_t>(pair.kind));
    for (const VertexId v : pair.vertices) hash.add(v);
    hash.add(pair.proximity);
  }
}

}  // namespace

void add_mesh_answers(Hash& hash) {
  const std::array cases = {pleated_sheet(20, 0, 1), pleated_sheet(8, -1060, 2), pleated_sheet(8, 900, 3)};
  for (const auto& [mesh, V_t0, V_t1, size] : cases) {
    std::vector<std::uint8_t> active(static_cast<std::size_t>(mesh.vertex_count), 0);
    for (std::size_t v = 0; v < active.size(); v += 5) active[v] = 1;
    for (const HierarchyKind kind : {HierarchyKind::kAutomatic, HierarchyKind::kSpatial, HierarchyKind::kTopology}) {
      BoxHierarchy hierarchy(mesh, kind);
      for (const double reach : {0.0, 0.3 * size}) {
        hierarchy.refit(V_t0, V_t1, {reach, {}});
        add(hash, hierarchy.candidates());
        hierarchy.refit(V_t0, V_t1, {reach, active});
        add(hash, hierarchy.candidates());
        hierarchy.refit(V_t0, V_t1, {reach, active, MotionBoxes::kMoving});
        add(hash, hierarchy.candidates());
      }
      const CcdOptions options = {0.001 * size, 64};
      hierarchy.refit(V_t0, V_t1, {options.tolerance, {}});
      const Candidates candidates = hierarchy.candidates();
      const CcdBatch batch(mesh, V_t0, V_t1, options, candidates.vf.size() + candidates.ee.size());
      add(hash, batch.ask(candidates.vf));
      add(hash, batch.ask(candidates.ee));
      add(hash, find_collisions(mesh, hierarchy, V_t0, V_t1, options, active));
      add(hash, find_proximities(mesh, hierarchy, V_t1, 0.1 * size));
    }
  }
}

}  // namespace selvage::testing
