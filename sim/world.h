// Everything about a scene that does not change while it runs.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/mesh_data.h"
#include "kernel/mesh.h"
#include "sim/bodies/collider.h"
#include "sim/collision_step.h"
#include "sim/scene/scene.h"
#include "sim/springs/spring.h"

namespace selvage::sim {

/// What was done to the faces of a body, so that contact sees one surface.
struct JoinedBody {
  std::int32_t vertices = 0;            ///< joined to the first one at their place: they have no face any more
  std::int32_t faces_without_area = 0;  ///< left out, or resolved (collinear_faces.h)
};

/// Vertices and faces: all cloths in the order of the scene, then all bodies.
struct World {
  io::Triangles triangles;
  std::vector<io::Group> groups;  ///< one per cloth and per body
  Mesh mesh;
  std::int32_t cloth_vertex_count = 0;
  std::vector<double> inverse_mass;   ///< #V, 1/kg; pins do not show here, as they may be released; 0 for bodies
  SpringSystem springs;               ///< of the cloth vertices
  StabilizerSystem stabilizers;       ///< of the cloth vertices
  std::vector<Collider> colliders;    ///< the bodies, then the pins; the index is the collision step's body id
  std::int32_t body_count = 0;        ///< of the colliders
  std::vector<JoinedBody> joined;     ///< by body
  std::vector<std::uint8_t> deforms;  ///< by collider: 1 where it deforms (collider.h)
  ContactSurfaces contacts;           ///< empty where no part has properties of its own, and no rest pairs
  std::vector<std::string> remarks;   ///< on mesh files that were not taken as they stand, for a person
  double stable_step_s = 0;           ///< of the springs
  Positions x_t0, v_t0;               ///< #V by 3 at time 0, on the lattice of the scene's precision
};

/// Who follows a script at a time.
struct ScriptedVertices {
  std::vector<double> inverse_mass;  ///< #V, 1/kg; 0 for what a collider holds
  std::vector<std::int32_t> body;    ///< #V: that collider, or -1
};
[[nodiscard]] ScriptedVertices scripted_at(const World& world, double time_s);
/// Refers to both.
[[nodiscard]] CollisionBodies bodies_of(const World& world, const ScriptedVertices& scripted, SqueezePolicy squeeze);

/// Reads the mesh and sequence files and builds. Throws io::Error: with the line of the scene, a bad mesh, a vertex
/// without mass, a pinned vertex out of range, sleeves that do not fit, and springs too stiff for explicit dynamics.
[[nodiscard]] World build_world(const Scene& scene);

}  // namespace selvage::sim
