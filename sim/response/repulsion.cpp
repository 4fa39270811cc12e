#include "sim/response/repulsion.h"

#include <algorithm>
#include <vector>

#include "sim/contact/contact_reach.h"

namespace selvage::sim {

Repulsion repulsion(double overlap, double displacement, double inverse_mass_kg, const CollisionOptions& options,
                    double dt_s) {
  Repulsion result;
  result.inelastic = std::max(-displacement - room_to_approach(overlap), 0.0);
  if (!(options.repulsion_stiffness_n_m > 0) || !(overlap > 0)) return result;
  const double limit = options.overlap_fraction * overlap - (displacement + result.inelastic);
  if (!(limit > 0)) return result;
  // v_N dt = dt * (k d dt) * K. Not `min`: an overflow times an underflow is NaN and must end at the limit too.
  const double spring = dt_s * dt_s * options.repulsion_stiffness_n_m * overlap * inverse_mass_kg;
  result.spring = spring < limit ? spring : limit;
  return result;
}

namespace {

/// How much farther apart the points are after `motion`, along the normal. Those of a rest pair, which is at its limit
/// wherever the cloth is as at rest, also where it turns: along where it lay before, a distance d that turns by an
/// angle a is shorter by d (1 - cos a), and to push that apart put energy into cloth that spun.
double moved_apart(const RepulsionContact& contact, const Vec3& motion) {
  const double along = motion.dot(contact.normal);
  if (!contact.properties.is_of_rest) return along;
  const Vec3 before = relative(contact.interaction, contact.x_t0), after = before + motion;
  return after.dot(contact.normal) > 0 ? std::max(along, after.norm() - before.norm()) : along;
}

}  // namespace

RepulsionChange repel_contact(const RepulsionContact& contact, const Positions& displacement,
                              const CollisionOptions& options, double dt_s, int sweep, FrictionLoad& load) {
  RepulsionChange result;
  const Interaction& interaction = contact.interaction;
  const PairVectors d = gather(interaction, displacement);
  const Vec3 motion = relative(interaction, d);
  const double displacement_n = moved_apart(contact, motion);
  const ContactProperties& properties = contact.properties;
  const double overlap = properties.thickness_m - contact.distance;
  const double approach = -displacement_n - room_to_approach(overlap);
  const double settled = sweep == 0 ? 0 : kSettledApproach * contact.distance;
  // A contact whose lever is limited acts once: its limits would add up.
  if (sweep == 0 || (approach > settled && lever_share(interaction) == 1)) {
    const Repulsion push = repulsion(overlap, displacement_n, contact.mobility * interaction.inverse_mass_scale,
                                     options, sweep == 0 ? dt_s : 0);
    result.repels = push.total() > 0;
    if (result.repels) {
      result.change = distribute(interaction, push.total() * contact.normal);
      load.pressed += lever_share(interaction) * push.total();
    }
  }
  if (!((motion - motion.dot(contact.normal) * contact.normal).norm() > settled)) return result;
  const FrictionCoefficients friction{properties.friction_static, properties.friction_kinetic};
  if (const auto rub = friction_change(interaction, contact.x_t0, d, contact.normal, friction, load)) {
    result.rubs = true;
    for (std::size_t i = 0; i < 4; ++i) result.change[i] += (*rub)[i];
  }
  return result;
}

void Contacts::clear() {
  contacts_.clear();
  loads_.clear();
  count_ = {};
}

void Contacts::repel(const CollisionOptions& options, double dt_s, int sweeps, StepMotion& motion) {
  const std::size_t first_new = loads_.size();
  loads_.resize(contacts_.size());
  for (int sweep = 0; sweep < sweeps; ++sweep) {
    bool settled = true;
    for (std::size_t k = 0; k < contacts_.size(); ++k) {
      const std::size_t at = sweep % 2 == 0 ? k : contacts_.size() - 1 - k;
      const int own_sweep = at < first_new ? sweep + 1 : sweep;
      const RepulsionContact& contact = contacts_[at];
      const RepulsionChange change =
          repel_contact(contact, motion.displacement(), options, dt_s, own_sweep, loads_[at]);
      if (!change.repels && !change.rubs) continue;
      settled = false;
      count_.repulsions += own_sweep == 0 && change.repels ? 1 : 0;
      count_.frictions += own_sweep == 0 && change.rubs ? 1 : 0;
      for (std::size_t i = 0; i < 4; ++i) {
        if (change.change[i].isZero(0)) continue;
        const VertexId vertex = contact.interaction.vertices[i];
        motion.move(vertex, motion.displacement().row(vertex).transpose() + change.change[i]);
      }
    }
    if (settled) break;
  }
}

std::vector<RepulsionContact> Contacts::pressed(std::size_t left_out) const {
  std::vector<RepulsionContact> result;
  for (std::size_t k = left_out; k < loads_.size(); ++k) {
    if (loads_[k].pressed > 0) result.push_back(contacts_[k]);
  }
  return result;
}

}  // namespace selvage::sim
