// What the parts of untangle() share: the positions so far, and a judge that counts.
#pragma once

#include <utility>

#include "sim/contact/surface_parts.h"
#include "sim/repair/untangle.h"
#include "sim/response/step_motion.h"

namespace selvage::sim {

inline constexpr double kRepairStep_s = 1;  ///< nothing has a time in a repair: no springs, no gravity

struct UntangleState {
  const Mesh& mesh;
  const CollisionBodies& bodies;
  const UntangleOptions& options;
  const FindIntersections& find;
  const SurfaceParts parts;
  const std::vector<std::uint8_t> is_cloth;  ///< #V (SurfaceParts::cloth_flags)
  const Positions V;                         ///< where it starts
  Positions x;                               ///< where it is now
  std::int32_t rounds = 0;

  [[nodiscard]] bool is_body(VertexId v) const { return is_cloth[static_cast<std::size_t>(v)] == 0; }
  [[nodiscard]] bool is_scripted(VertexId v) const { return !(bodies.inverse_mass[static_cast<std::size_t>(v)] > 0); }
  [[nodiscard]] bool is_body_face(FaceId f) const { return is_body(mesh.faces[static_cast<std::size_t>(f)][0]); }
  /// For certified steps.
  [[nodiscard]] CollisionStep make_step() const { return {mesh, step_options(options), options.surfaces}; }
  [[nodiscard]] bool may_judge() const { return rounds < kMaxUntangleRounds; }

  [[nodiscard]] std::vector<FacePair> judge(const Positions& at) {
    ++rounds;
    return find(at);
  }
  /// Of the pairs, those of two faces of cloth, or those with one of a body.
  [[nodiscard]] std::vector<FacePair> only(std::vector<FacePair> pairs, bool with_body) const {
    std::erase_if(pairs, [&](const FacePair& p) { return (is_body_face(p[0]) || is_body_face(p[1])) != with_body; });
    return pairs;
  }
  [[nodiscard]] Vec3 on_lattice(const Vec3& point) const {
    return point.unaryExpr([this](double c) { return to_lattice(c, options.precision); });
  }
};

}  // namespace selvage::sim
