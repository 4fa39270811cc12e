#include "sim/description.h"

#include <algorithm>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "sim/bodies/body_sequence.h"

namespace selvage::sim {
namespace {

/// "tolerance 1e-06 m", and what repulsions bring where there are any.
std::vector<std::string> describe(const ContactProperties& contact, bool repulsion) {
  std::vector<std::string> parts{fmt::format("tolerance {:g} m", contact.tolerance_m)};
  if (repulsion) parts.push_back(fmt::format("repulsion below {:g} m", contact.thickness_m));
  if (repulsion && contact.friction_static > 0) {
    parts.push_back(
        fmt::format("friction {:g} static, {:g} kinetic", contact.friction_static, contact.friction_kinetic));
  }
  return parts;
}

}  // namespace

std::string describe(const Scene& scene, const World& world) {
  std::string text;
  const auto line = [&](const char* what, const std::string& value) { text += fmt::format("{:<11}{}\n", what, value); };
  const auto count = [&](SpringKind kind) {
    return std::count_if(world.springs.springs().begin(), world.springs.springs().end(),
                         [&](const Spring& spring) { return spring.kind == kind; });
  };
  for (const io::Group& group : world.groups) {
    line(group.role == io::Group::Role::kCloth ? "cloth" : "body",
         fmt::format("{}, {} faces", group.name, group.face_end - group.face_begin));
  }
  const auto owners = std::span(world.mesh.vertex_owner).first(static_cast<std::size_t>(world.cloth_vertex_count));
  if (const auto loose = std::ranges::count(owners, -1); loose > 0) {
    line("", fmt::format("{} cloth vertices of no face, which move alone", loose));
  }
  for (const Collider& collider : world.colliders) {
    const BodySequence* sequence = collider.sequence();
    if (sequence == nullptr) continue;
    line("", fmt::format("{}: {} frames of a sequence, from {:g} to {:g} s", collider.name(), sequence->frame_count(),
                         sequence->begin_s(), sequence->end_s()));
  }
  for (std::size_t body = 0; body < world.joined.size(); ++body) {
    const auto& [vertices, faces] = world.joined[body];
    std::vector<std::string> parts;
    if (vertices > 0) parts.push_back(fmt::format("{} vertices joined to others at their place", vertices));
    if (faces > 0) parts.push_back(fmt::format("{} faces without area resolved", faces));
    if (!parts.empty()) line("", fmt::format("{}: {}", world.colliders[body].name(), fmt::join(parts, ", ")));
  }
  line("springs", fmt::format("{} structural", count(SpringKind::kStructural)));
  if (count(SpringKind::kShear) > 0) line("", fmt::format("{} shear", count(SpringKind::kShear)));
  if (count(SpringKind::kBending) > 0) line("", fmt::format("{} bending", count(SpringKind::kBending)));
  if (!world.stabilizers.empty()) line("", fmt::format("{} stabilising", world.stabilizers.stabilizers().size()));
  for (const ClothSpec& cloth : scene.cloths) {
    if (cloth.damping_ratio > 0) line("damping", fmt::format("{}: {:g} of critical", cloth.name, cloth.damping_ratio));
  }
  if (scene.strain.strain > 0) line("limits", fmt::format("strain {:g}", scene.strain.strain));
  if (scene.strain.strain_rate > 0) line("limits", fmt::format("strain rate {:g} a step", scene.strain.strain_rate));
  if (scene.gravity_m_s2 != Vec3::Zero()) {
    line("gravity", fmt::format("({:g}, {:g}, {:g}) m/s^2", scene.gravity_m_s2.x(), scene.gravity_m_s2.y(),
                                scene.gravity_m_s2.z()));
  }
  if (scene.drag_1_s > 0) line("air", fmt::format("drag {:g} 1/s", scene.drag_1_s));
  if (scene.quadratic_drag_1_m > 0) line("air", fmt::format("drag {:g} 1/m, quadratic", scene.quadratic_drag_1_m));
  if (scene.solver == Solver::kImplicit) line("solver", "implicit");
  auto n = static_cast<std::size_t>(world.body_count);
  for (const ClothSpec& cloth : scene.cloths) {
    for (const PinSpec& spec : cloth.pins) {
      const Collider& pin = world.colliders[n++];
      const std::string carrier = spec.body ? ", on " + scene.bodies[*spec.body].name : "";
      line("pin", fmt::format("{}, {} vertices{}", pin.name(), pin.vertices().size(), carrier));
    }
  }
  if (scene.squeeze == SqueezePolicy::kYield) line("squeezed", "bodies wait for the cloth, or go on along it");
  const char* what = "contact";
  for (const std::string& part : describe(contact_of(scene.collision), scene.collision.repulsion)) {
    line(what, part);
    what = "";
  }
  if (scene.collision.repulsion && scene.contact_sweeps > 1) {
    line("", fmt::format("{} sweeps over held contacts in a step of the dynamics", scene.contact_sweeps));
  }
  const auto describe_own = [&](const auto& part) {
    if (!part.contact) return;
    line("", fmt::format("{}: {}", part.name, fmt::join(describe(*part.contact, scene.collision.repulsion), ", ")));
  };
  for (const ClothSpec& cloth : scene.cloths) describe_own(cloth);
  for (const BodySpec& body : scene.bodies) describe_own(body);
  if (scene.collision.precision == CollisionOptions::Precision::kFloat32) line("state", "on the float32 lattice");
  return text;
}

}  // namespace selvage::sim
