#include "sim/start_repair.h"

#include <algorithm>
#include <utility>

#include "sim/relax_springs.h"
#include "sim/surface_parts.h"

namespace selvage::sim {
namespace {

/// Who is cloth at the start.
struct StartBodies {
  std::vector<double> inverse_mass;
  std::vector<std::int32_t> body;

  explicit StartBodies(const World& world) : inverse_mass(world.inverse_mass), body(inverse_mass.size(), -1) {
    for (std::size_t id = 0; id < world.colliders.size(); ++id) {
      if (!world.colliders[id].holds(0)) continue;
      for (const VertexId vertex : world.colliders[id].vertices()) {
        inverse_mass[static_cast<std::size_t>(vertex)] = 0;
        body[static_cast<std::size_t>(vertex)] = static_cast<std::int32_t>(id);
      }
    }
  }
  [[nodiscard]] CollisionBodies bodies(std::int32_t body_count) const {
    return {inverse_mass, body, SqueezePolicy::kStop, body_count};
  }
  /// Parts of the surface that are where they were stay there.
  void hold_what_did_not_move(const Mesh& mesh, const Positions& before, const Positions& after) {
    const SurfaceParts parts(mesh);
    std::vector<std::uint8_t> moved(inverse_mass.size(), 0);
    for (VertexId v = 0; v < mesh.vertex_count; ++v) {
      if (before.row(v) != after.row(v)) moved[static_cast<std::size_t>(parts.part(v))] = 1;
    }
    for (VertexId v = 0; v < mesh.vertex_count; ++v) {
      if (moved[static_cast<std::size_t>(parts.part(v))] == 0) inverse_mass[static_cast<std::size_t>(v)] = 0;
    }
  }
};

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
  CollisionOptions options;
  options.thickness_m = untangled.gap_m;
  options.tolerance_m = untangled.tolerance_m;
  options.precision = untangled.precision;
  CollisionStep step(world.mesh, options, untangled.surfaces);
  const double limit = simulation.scene().strain.strain;
  return relax_springs(x, world.springs, world.stabilizers.empty() ? nullptr : &world.stabilizers, step, bodies,
                       limit > 0 ? limit : StrainLimits().strain);
}

}  // namespace

RepairedStart repair_start(const Simulation& simulation, const FindIntersections& find) {
  const World& world = simulation.world();
  StartBodies start(world);
  const UntangleOptions options = untangle_options(simulation.scene(), world);
  UntangleResult untangled = untangle(world.mesh, simulation.x(), start.bodies(world.body_count), options, find);
  RepairedStart result{std::move(untangled.x), std::move(untangled.report.remaining), untangled.report.rounds};
  if (!result.remaining.empty()) return result;
  start.hold_what_did_not_move(world.mesh, simulation.x(), result.x);
  RelaxedSprings relaxed = relax(simulation, result.x, start.bodies(world.body_count), options);
  result.x = std::move(relaxed.x);
  result.relax_steps = relaxed.steps;
  result.largest_strain = relaxed.largest_strain;
  return result;
}

}  // namespace selvage::sim
