#include "sim/repair/start_repair.h"

#include <algorithm>
#include <utility>

#include "sim/contact/surface_parts.h"
#include "sim/repair/relax_springs.h"

namespace selvage::sim {
namespace {

/// Parts of the surface that are where they were stay there.
void hold_what_did_not_move(const Mesh& mesh, const Positions& before, const Positions& after,
                            std::vector<double>& inverse_mass) {
  const SurfaceParts parts(mesh);
  std::vector<std::uint8_t> moved(inverse_mass.size(), 0);
  for (VertexId v = 0; v < mesh.vertex_count; ++v) {
    if (before.row(v) != after.row(v)) moved[static_cast<std::size_t>(parts.part(v))] = 1;
  }
  for (VertexId v = 0; v < mesh.vertex_count; ++v) {
    if (moved[static_cast<std::size_t>(parts.part(v))] == 0) inverse_mass[static_cast<std::size_t>(v)] = 0;
  }
}

/// What keeps parts apart in the scene.
UntangleOptions untangle_options(const Scene& scene, const World& world) {
  const CollisionOptions& collision = scene.collision;
  UntangleOptions options{collision.thickness_m, collision.tolerance_m, collision.precision, world.contacts};
  for (ContactProperties& part : options.surfaces.properties) part.friction_static = part.friction_kinetic = 0;
  if (options.surfaces.properties.empty()) return options;
  options.gap_m = 0;
  for (const std::int32_t number : options.surfaces.surface_of_vertex) {
    options.gap_m = std::max(options.gap_m, options.surfaces.properties[static_cast<std::size_t>(number)].thickness_m);
  }
  return options;
}

RelaxedSprings relax(const Simulation& simulation, const Positions& x, const CollisionBodies& bodies,
                     const UntangleOptions& untangled) {
  const World& world = simulation.world();
  CollisionStep step(world.mesh, step_options(untangled), untangled.surfaces);
  const double limit = simulation.scene().strain.strain;
  return relax_springs(x, world.springs, world.stabilizers.empty() ? nullptr : &world.stabilizers, step, bodies,
                       limit > 0 ? limit : StrainLimits().strain);
}

}  // namespace

RepairedStart repair_start(const Simulation& simulation, const FindIntersections& find) {
  const World& world = simulation.world();
  ScriptedVertices scripted = scripted_at(world, 0);
  const auto bodies = [&] { return bodies_of(world, scripted, SqueezePolicy::kStop); };
  const UntangleOptions options = untangle_options(simulation.scene(), world);
  UntangleResult untangled = untangle(world.mesh, simulation.x(), bodies(), options, find);
  RepairedStart result;
  result.x = std::move(untangled.x);
  result.remaining = std::move(untangled.report.remaining);
  result.rounds = untangled.report.rounds;
  if (!result.remaining.empty()) return result;
  hold_what_did_not_move(world.mesh, simulation.x(), result.x, scripted.inverse_mass);
  RelaxedSprings relaxed = relax(simulation, result.x, bodies(), options);
  result.x = std::move(relaxed.x);
  result.relax_steps = relaxed.steps;
  result.largest_strain = relaxed.largest_strain;
  for (Eigen::Index v = 0; v < result.x.rows(); ++v) {
    const double moved_m = (result.x.row(v) - simulation.x().row(v)).stableNorm();
    result.moved_vertices += moved_m > 0 ? 1 : 0;
    result.largest_move_m = std::max(result.largest_move_m, moved_m);
  }
  return result;
}

}  // namespace selvage::sim
