#include "sim/step_input.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "sim/base/lattice.h"

namespace selvage::sim {
namespace {

/// Far above the rounding of any normal, far below what changes a contact.
constexpr double kUnitRounding = 1e-6;
constexpr double kMaxMobility = 4 + kUnitRounding;  // four weights and mobilities of 1

bool is_finite_nonnegative(double value) { return value >= 0 && std::isfinite(value); }

bool is_on_lattice(const PositionsRef& V, CollisionOptions::Precision precision) {
  for (Eigen::Index v = 0; v < V.rows(); ++v) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (to_lattice(V(v, axis), precision) != V(v, axis)) return false;
    }
  }
  return true;
}

InputError validate_bodies(std::size_t vertex_count, const CollisionBodies& bodies) {
  if (bodies.inverse_mass.size() != vertex_count) return InputError::kSizeMismatch;
  if (!bodies.body.empty() && bodies.body.size() != vertex_count) return InputError::kSizeMismatch;
  for (std::size_t v = 0; v < vertex_count; ++v) {
    if (!is_finite_nonnegative(bodies.inverse_mass[v])) return InputError::kBadMass;
    const std::int32_t body = bodies.body.empty() ? -1 : bodies.body[v];
    if (body < -1) return InputError::kBadBodies;
    if (body >= 0 && bodies.inverse_mass[v] > 0) return InputError::kBadMass;
  }
  const bool is_policy = bodies.policy == SqueezePolicy::kStop || bodies.policy == SqueezePolicy::kYield;
  return is_policy && bodies.first_pin >= 0 ? InputError::kNone : InputError::kBadBodies;
}

/// Cloth may be sent to any finite place: StepMotion cuts its candidates at the edge of the domain. A script is
/// followed exactly, so one that leaves the domain is refused.
InputError validate_candidate(const PositionsRef& V_candidate, std::span<const double> inverse_mass,
                              CollisionOptions::Precision precision) {
  if (!V_candidate.allFinite()) return InputError::kNotFinite;
  const double limit = to_lattice(std::numeric_limits<double>::max(), precision);
  for (Eigen::Index v = 0; v < V_candidate.rows(); ++v) {
    const bool is_scripted = inverse_mass[static_cast<std::size_t>(v)] == 0;
    if (is_scripted && V_candidate.row(v).cwiseAbs().maxCoeff() > limit) return InputError::kTooLarge;
  }
  return InputError::kNone;
}

}  // namespace

std::string_view first_bad_option(const CollisionOptions& o) {
  if (const std::string_view name = first_bad_value(contact_of(o)); !name.empty()) return name;
  if (!is_finite_nonnegative(o.repulsion_stiffness_n_m)) return "repulsion_stiffness_n_m";
  if (!(o.overlap_fraction >= 0 && o.overlap_fraction <= 1)) return "overlap_fraction";
  if (!(o.relaxation > 0 && o.relaxation <= 1)) return "relaxation";
  if (o.max_impulse_rounds < 0) return "max_impulse_rounds";
  if (o.max_zone_rounds < 0) return "max_zone_rounds";
  if (o.precision != Precision::kFloat64 && o.precision != Precision::kFloat32) return "precision";
  return o.max_intervals < 1 ? "max_intervals" : "";
}

InputError validate_step_input(const Mesh& mesh, const CollisionOptions& options, const PositionsRef& V_t0,
                               const PositionsRef& V_candidate, const CollisionBodies& bodies, double dt_s) {
  if (!first_bad_option(options).empty()) return InputError::kBadOption;
  if (!(dt_s > 0) || !std::isfinite(dt_s)) return InputError::kBadTimeStep;
  if (const InputError error = validate(mesh, V_t0, V_t0); error != InputError::kNone) return error;
  if (V_candidate.rows() != V_t0.rows()) return InputError::kSizeMismatch;
  const auto vertex_count = static_cast<std::size_t>(mesh.vertex_count);
  if (const InputError error = validate_bodies(vertex_count, bodies); error != InputError::kNone) return error;
  if (const InputError error = validate_candidate(V_candidate, bodies.inverse_mass, options.precision);
      error != InputError::kNone) {
    return error;
  }
  return is_on_lattice(V_t0, options.precision) ? InputError::kNone : InputError::kOffLattice;
}

InputError validate_held(const Mesh& mesh, std::span<const RepulsionContact> held) {
  const auto is_vertex = [&](VertexId v) { return v >= 0 && v < mesh.vertex_count; };
  constexpr std::size_t kPairVertices = 4;  // of vf and ee pairs
  for (const RepulsionContact& contact : held) {
    const std::size_t count = contact.kind == PairKind::kVf ? mesh.faces.size() : mesh.edges.size();
    const auto is_second = [&](std::int32_t id) { return id >= 0 && static_cast<std::size_t>(id) < count; };
    const bool is_first = contact.kind == PairKind::kVf ? is_vertex(contact.first) : is_second(contact.first);
    const bool is_pair = contact.kind == PairKind::kVf || contact.kind == PairKind::kEe;
    const bool fits = is_pair && is_first && is_second(contact.second) && is_second(contact.second_t0) &&
                      contact.interaction.vertex_count == kPairVertices &&
                      contact.interaction.vertices == pair_vertices(mesh, contact.kind, contact.first, contact.second);
    if (!fits) return InputError::kBadContact;
    const auto is_finite = [](double value) { return std::isfinite(value); };
    const auto is_weight = [](double value) { return std::abs(value) <= 1 + kUnitRounding; };
    const auto is_share = [](double value) { return value >= 0 && value <= 1; };
    const auto is_place = [](const Vec3& x) { return (x.array().abs() <= kMaxCoordinate).all(); };
    const auto& [vertices, weights, vertex_count, mobility, scale] = contact.interaction;
    const bool finite = contact.normal.allFinite() && std::abs(contact.distance) <= kMaxCoordinate &&
                        contact.mobility > 0 && contact.mobility <= kMaxMobility && is_finite(scale) &&
                        is_valid(contact.properties) && std::ranges::all_of(weights, is_weight) &&
                        std::ranges::all_of(mobility, is_share) && std::ranges::all_of(contact.x_t0, is_place);
    const bool is_unit = std::abs(contact.normal.norm() - 1) <= kUnitRounding;
    if (!finite || !is_unit) return InputError::kBadContact;
  }
  return InputError::kNone;
}

}  // namespace selvage::sim
