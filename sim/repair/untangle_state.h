// What the parts of untangle() share: the positions so far, and a judge that counts.
#pragma once

#include <algorithm>
#include <utility>

#include "kernel/assert.h"
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

  /// REQUIRES a find() that names faces of the mesh.
  [[nodiscard]] std::vector<FacePair> judge(const Positions& at) {
    ++rounds;
    std::vector<FacePair> found = find(at);
    const auto is_face = [&](FaceId f) { return f >= 0 && static_cast<std::size_t>(f) < mesh.faces.size(); };
    SELVAGE_REQUIRE(std::ranges::all_of(found, [&](const FacePair& p) { return is_face(p[0]) && is_face(p[1]); }));
    return found;
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
