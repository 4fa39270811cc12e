// Scenes for tests of the collision step: parts placed into one mesh, the step, and the exact check of what it returns.
#pragma once

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sim/base/points.h"
#include "sim/collision_step.h"
#include "sim/scene/shapes.h"
#include "verify/check.h"

namespace selvage::sim::testbed {

inline Shape sheet(std::int32_t side, double width_m = 0.1) { return make_sheet(side, side, width_m, width_m); }

/// A single triangle of about `size_m`, in the plane z = 0, around the origin.
inline Shape triangle(double size_m) {
  Shape shape;
  shape.x.resize(3, 3);
  shape.x << -size_m, -size_m, 0, size_m, -size_m, 0, 0, size_m, 0;
  shape.triangles = {{0, 1, 2}};
  return shape;
}

struct StepScene {
  struct Part {
    VertexId begin = 0, end = 0;
  };

  /// Appends a shape shifted by `shift`; `body` -1 is cloth of 1 kg a vertex.
  Part add(const Shape& shape, const Vec3& shift, std::int32_t body_id = -1) {
    const Part part{static_cast<VertexId>(V_t0.rows()), static_cast<VertexId>(V_t0.rows() + shape.x.rows())};
    V_t0.conservativeResize(part.end, 3);
    V_t0.bottomRows(shape.x.rows()) = shape.x.rowwise() + shift.transpose();
    for (const auto& t : shape.triangles) {
      triangles.push_back({t[0] + part.begin, t[1] + part.begin, t[2] + part.begin});
      face_is_body.push_back(body_id >= 0 ? 1 : 0);
    }
    inverse_mass.insert(inverse_mass.end(), static_cast<std::size_t>(shape.x.rows()), body_id >= 0 ? 0.0 : 1.0);
    body.insert(body.end(), static_cast<std::size_t>(shape.x.rows()), body_id);
    V_candidate = V_t0;
    return part;
  }
  void push(const Part& part, const Vec3& displacement) {
    for (VertexId v = part.begin; v < part.end; ++v) V_candidate.row(v) += displacement.transpose();
  }
  [[nodiscard]] CollisionBodies bodies() const {
    return {.inverse_mass = inverse_mass, .body = body, .policy = policy, .deforms = deforms};
  }
  [[nodiscard]] Mesh mesh() const { return make_mesh(static_cast<std::int32_t>(V_t0.rows()), triangles); }
  [[nodiscard]] CollisionStepResult step() const {
    const Mesh connectivity = mesh();
    return CollisionStep(connectivity, options, surfaces)(V_t0, V_candidate, bodies(), dt_s);
  }
  /// Steps on from the result: its positions become V_t0, and the candidates continue with `velocity`.
  void advance(const CollisionStepResult& result) {
    V_t0 = result.x;
    V_candidate = V_t0 + dt_s * result.velocity;
  }

  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::uint8_t> face_is_body;
  Positions V_t0{0, 3}, V_candidate{0, 3};
  std::vector<double> inverse_mass;
  std::vector<std::int32_t> body;
  SqueezePolicy policy = SqueezePolicy::kStop;
  CollisionOptions options;
  ContactSurfaces surfaces;
  std::vector<std::uint8_t> deforms;  ///< by body, as in CollisionBodies
  double dt_s = 1e-2;
};

inline double lowest(const Positions& x, const StepScene::Part& part) {
  return x.block(part.begin, 2, part.end - part.begin, 1).minCoeff();
}
inline double highest(const Positions& x, const StepScene::Part& part) {
  return x.block(part.begin, 2, part.end - part.begin, 1).maxCoeff();
}

/// What the exact checker holds against a state, "" for nothing.
inline std::string exact_defect(const StepScene& scene, const Positions& x) {
  const verify::Surface surface{scene.triangles, scene.face_is_body};
  const verify::CheckResult frame = check_frame(surface, points_of(x), {});
  if (frame.violations_total.total() == 0) return "";
  return "frame: " + std::to_string(frame.violations_total.total()) + " violations, first " +
         frame.violations.front().kind;
}

/// S1 and S4, exactly: the frame, the motion from V_t0, the domain, and the scripted vertices of bodies that did not
/// wait.
inline std::string exact_defect(const StepScene& scene, const CollisionStepResult& result) {
  if (result.report.status != StepStatus::kSafe) return "the step did not succeed";
  if (!result.x.allFinite() || !result.velocity.allFinite()) return "not finite";
  const verify::Surface surface{scene.triangles, scene.face_is_body};
  const verify::CheckResult motion = check_motion(surface, points_of(scene.V_t0), points_of(result.x), {});
  if (motion.violations_total.total() != 0) {
    return "motion: " + std::to_string(motion.violations_total.total()) + " violations, first " +
           motion.violations.front().kind;
  }
  for (std::size_t v = 0; v < scene.inverse_mass.size(); ++v) {
    if (scene.inverse_mass[v] > 0) continue;
    const auto row = static_cast<Eigen::Index>(v);
    const bool deforms = scene.body[v] >= 0 && static_cast<std::size_t>(scene.body[v]) < scene.deforms.size() &&
                         scene.deforms[static_cast<std::size_t>(scene.body[v])] != 0;
    const bool body_waits = std::ranges::count(result.report.waiting_bodies, scene.body[v]) > 0;
    const bool waits = std::ranges::binary_search(result.report.waiting_vertices, static_cast<VertexId>(v));
    if (waits != body_waits && !(body_waits && deforms)) return "a rigid body waits in part, or unsaid";
    if (result.x.row(row) != (waits ? scene.V_t0 : scene.V_candidate).row(row))
      return "a scripted vertex left its script";
  }
  for (const Collision& c : result.report.below_tolerance) {
    if (c.ccd.cause != CcdCause::kEnd) return "a pair is below tolerance for another cause than its end";
  }
  return exact_defect(scene, result.x);
}

}  // namespace selvage::sim::testbed
