// Small worlds for the collision step (S1 to S3): a mesh in a state that is exactly free of intersections, and
// candidate positions that try to break it.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/base/choice_source.h"
#include "fuzz/draw/surface_makers.h"
#include "sim/base/points.h"
#include "sim/collision_step.h"
#include "verify/check.h"

namespace selvage::fuzz {

struct StepWorld {
  std::string_view surface;  ///< name of the class it was made by
  Mesh mesh;
  verify::Topology topology;  ///< the checker's own view of the same faces
  Positions x;                ///< exactly free of intersections, on the float32 lattice if the options ask for it
  std::vector<double> inverse_mass;  ///< 1/kg; 0: scripted
  std::vector<std::int32_t> body;
  sim::CollisionOptions options;
  sim::SqueezePolicy policy = sim::SqueezePolicy::kStop;
  double dt_s = 0x1p-5;
  double spacing_m = 1;  ///< a length that describes the mesh, and the distance between its layers
  double gap_m = 1;

  [[nodiscard]] bool is_scripted(std::int32_t vertex) const {
    return inverse_mass[static_cast<std::size_t>(vertex)] == 0;
  }
  [[nodiscard]] bool deforms(std::int32_t vertex) const {
    const auto number = static_cast<std::size_t>(body[static_cast<std::size_t>(vertex)]);  // -1 is beyond all
    return number < kDeforms.size() && kDeforms[number] != 0;
  }
  [[nodiscard]] sim::CollisionBodies bodies() const {
    return {.inverse_mass = inverse_mass, .body = body, .policy = policy, .deforms = kDeforms};
  }

  /// Every second body does, of any world: so a case that is kept need not say it.
  static constexpr std::array<std::uint8_t, 8> kDeforms{0, 1, 0, 1, 0, 1, 0, 1};
};

using Triples = std::vector<std::array<std::int32_t, 3>>;
/// Sets mesh and topology. REQUIRES that the masses are set, which say what is scripted.
void connect(StepWorld& world, const Triples& faces);
/// Whether nothing of the cloth intersects, exactly.
[[nodiscard]] bool is_clean(const StepWorld& world, const Positions& x);

/// Surfaces: sheets, crumpled grid, soup of separate triangles, nested closed shells, needles, stack of cards, cloth
/// between bodies; with noise, offset 2^k, scale 2^k, masses, tolerances and thicknesses chosen from `source`.
/// What rounding would make intersect is made again without noise and offset, so the state is always clean.
[[nodiscard]] StepWorld make_step_world(ChoiceSource& source);
/// The same with a surface of this class.
[[nodiscard]] StepWorld make_step_world(ChoiceSource& source, const SurfaceClass& surface);

/// Ways to choose candidate positions.
inline constexpr std::size_t kCandidateClassCount = 11;
/// Candidates for a step from x: smooth or wild motion, layers swapped, everything at one point or in one plane,
/// exploded, mirrored, vertices permuted, no motion at all. Finite; scripted vertices move in the same spirit, but each
/// body by one translation.
[[nodiscard]] Positions choose_candidate(ChoiceSource& source, const StepWorld& world, const Positions& x,
                                         std::string_view& candidate_class);

/// A length that matters for what is near, or zero.
[[nodiscard]] double choose_length(ChoiceSource& source, const StepWorld& world);
/// #V flags, of which about a quarter are set, or none at all: every vertex is active.
[[nodiscard]] std::vector<std::uint8_t> choose_active(ChoiceSource& source, const StepWorld& world);

/// Violations of the exact check that concern cloth: those whose vertices are all scripted are not the step's.
[[nodiscard]] std::int64_t cloth_violations(const StepWorld& world, const verify::CheckResult& result);

}  // namespace selvage::fuzz
