#include "sim/scripted_motion.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "sim/bodies/catch_up.h"

namespace selvage::sim {

ScriptedMotion::ScriptedMotion(const Scene& scene, const World& world)
    : scene_(scene), world_(world), blocked_(scene.collision.thickness_m) {
  std::set<std::int32_t> cloth_surfaces;
  if (!world.contacts.properties.empty()) {
    const auto surfaces = std::span(world.contacts.surface_of_vertex);
    for (const std::int32_t surface : surfaces.first(static_cast<std::size_t>(world.cloth_vertex_count))) {
      cloth_surfaces.insert(surface);
    }
  }
  carried_by_.resize(world.colliders.size());
  for (std::size_t i = 0; i < world.colliders.size(); ++i) {
    thickness_.push_back(thickness_with_cloth(world.colliders[i], cloth_surfaces));
    if (const auto carrier = world.colliders[i].carrier()) carried_by_[*carrier].push_back(i);
  }
}

ScriptedMotion::Thickness ScriptedMotion::thickness_with_cloth(const Collider& collider,
                                                               const std::set<std::int32_t>& cloth_surfaces) const {
  const ContactSurfaces& contacts = world_.contacts;
  Thickness result{scene_.collision.thickness_m, scene_.collision.thickness_m};
  if (contacts.properties.empty() || collider.vertices().empty()) return result;
  const auto properties_of = [&](std::int32_t surface) {
    return contacts.properties[static_cast<std::size_t>(surface)];
  };
  const auto first = static_cast<std::size_t>(collider.vertices().front());
  const ContactProperties own = properties_of(contacts.surface_of_vertex[first]);
  result = {std::numeric_limits<double>::infinity(), 0};
  for (const std::int32_t surface : cloth_surfaces) {
    const double thickness_m = combine(properties_of(surface), own).thickness_m;
    result.least_m = std::min(result.least_m, thickness_m);
    result.most_m = std::max(result.most_m, thickness_m);
  }
  return result;
}

void ScriptedMotion::start_step(double time_s) {
  waits_.assign(static_cast<std::size_t>(world_.x_t0.rows()), 0);
  blocked_.start_step(time_s);
}

Eigen::AlignedBox3d ScriptedMotion::box_of_cloth(const Positions& x, const Positions& v, double dt_s) const {
  const Vec3 fall = dt_s * dt_s / 2 * scene_.gravity_m_s2;
  Eigen::AlignedBox3d box;
  for (Eigen::Index i = 0; i < world_.cloth_vertex_count; ++i) {
    const Vec3 at = x.row(i), way = dt_s * v.row(i);
    box.extend(at).extend(at + way).extend(at + way + fall);
  }
  return box;
}

ScriptedMotion::Way ScriptedMotion::way(const Positions& x, const Positions& v, const StepClock& clock) const {
  const double t0_s = clock.time_s(), t1_s = clock.end_s();
  std::optional<Eigen::AlignedBox3d> cloth;  // of its way, once a body asks
  const auto may_meet_cloth = [&](const Eigen::AlignedBox3d& within, double thickness_m) {
    if (!cloth) cloth = box_of_cloth(x, v, clock.dt_s());
    return cloth->squaredExteriorDistance(within) <= thickness_m * thickness_m;
  };
  const auto way_of = [&](const Collider::Bend& bend, const Thickness& thickness) {
    const bool is_bent = bend.leaves_line_by_m > thickness.least_m;
    if (!is_bent && bend.off_by_m <= thickness.least_m) return Way::kAsSeen;
    if (!may_meet_cloth(bend.within, thickness.most_m)) return Way::kAsSeen;
    return is_bent ? Way::kBent : Way::kUneven;
  };
  Way worst = Way::kAsSeen;
  for (std::size_t i = 0; i < world_.colliders.size(); ++i) {
    const Collider& collider = world_.colliders[i];
    if (collider.carrier() || !collider.holds(t0_s)) continue;
    std::vector<std::size_t> moved = {i};
    std::vector<const Collider*> carried;
    for (const std::size_t pin : carried_by_[i]) {
      if (!world_.colliders[pin].holds(t0_s)) continue;
      moved.push_back(pin);
      carried.push_back(&world_.colliders[pin]);
    }
    const std::vector<Collider::Bend> bends = collider.bends(t0_s, t1_s, carried);
    for (std::size_t k = 0; k < moved.size(); ++k) worst = std::max(worst, way_of(bends[k], thickness_[moved[k]]));
    if (worst == Way::kBent) break;
  }
  return worst;
}

// First the bodies, then the pins, which may hang on them.
Positions ScriptedMotion::follow(const Positions& x, const StepClock& clock) {
  scripted_ = scripted_at(world_, clock.time_s());
  Positions x_t1 = x;
  bow_m_.setZero(x.rows() - world_.cloth_vertex_count, 3);
  is_led_.assign(static_cast<std::size_t>(x.rows()), 0);
  for (const Collider& collider : world_.colliders) {
    if (collider.holds(clock.time_s())) follow(collider, x, clock, x_t1);
  }
  return x_t1;
}

void ScriptedMotion::follow(const Collider& collider, const Positions& x_t0, const StepClock& clock, Positions& x) {
  const Precision precision = scene_.collision.precision;
  const std::vector<VertexId>& vertices = collider.vertices();
  Positions script_t1 = collider.placed_at(clock.end_s(), precision, x);
  bool is_on_script = true;
  if (scene_.squeeze == SqueezePolicy::kYield) {  // else none has ever waited
    const Positions now = x_t0(vertices, Eigen::all), script_t0 = collider.placed_at(clock.time_s(), precision, x_t0);
    is_on_script = now == script_t0;
    if (!is_on_script) {
      const double least_speed_m_s = scene_.collision.thickness_m / kCatchUpTime_s;
      const auto catch_script = collider.deforms() ? catch_up_each : catch_up;
      script_t1 = catch_script(now, script_t0, script_t1, clock.dt_s(), least_speed_m_s);
    }
  }
  is_on_script = !lead_round(collider, x_t0, clock.dt_s(), script_t1) && is_on_script;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (waits_[static_cast<std::size_t>(vertices[i])] == 0)
      x.row(vertices[i]) = script_t1.row(static_cast<Eigen::Index>(i));
  }
  if (is_on_script) set_bow(collider, clock);
}

bool ScriptedMotion::lead_round(const Collider& collider, const Positions& x_t0, double dt_s, Positions& x_t1) {
  const std::vector<VertexId>& vertices = collider.vertices();
  if (blocked_.all().empty() || vertices.empty()) return false;
  const std::int32_t body = scripted_.body[static_cast<std::size_t>(vertices.front())];
  const Positions straight = x_t1;
  if (!blocked_.lead_round(body, vertices, x_t0(vertices, Eigen::all), dt_s, x_t1)) return false;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    if (x_t1.row(row) != straight.row(row)) is_led_[static_cast<std::size_t>(vertices[i])] = 1;
  }
  return true;
}

void ScriptedMotion::set_bow(const Collider& collider, const StepClock& clock) {
  const std::vector<VertexId>& vertices = collider.vertices();
  if (vertices.empty() || vertices.front() < world_.cloth_vertex_count) return;  // pins move as springs have them
  const Positions rows = collider.bow_m(clock.time_s(), clock.end_s());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (waits_[static_cast<std::size_t>(vertices[i])] != 0) continue;
    bow_m_.row(vertices[i] - world_.cloth_vertex_count) = rows.row(static_cast<Eigen::Index>(i));
  }
}

void ScriptedMotion::wait(const CollisionStepReport& report) {
  if (blocked_.add(report.blockages)) return;
  for (const VertexId v : report.waiting_vertices) waits_[static_cast<std::size_t>(v)] = 1;
}

std::pair<std::vector<std::int32_t>, std::vector<VertexId>> ScriptedMotion::waiting() const {
  std::set<std::int32_t> bodies;
  std::vector<VertexId> vertices;
  for (VertexId v = 0; v < static_cast<VertexId>(waits_.size()); ++v) {
    const auto row = static_cast<std::size_t>(v);
    if (waits_[row] == 0 && is_led_[row] == 0) continue;
    bodies.insert(scripted_.body[row]);
    vertices.push_back(v);
  }
  return {std::vector<std::int32_t>(bodies.begin(), bodies.end()), std::move(vertices)};
}

}  // namespace selvage::sim
