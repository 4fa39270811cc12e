// The contacts of a collision step: two points of the surface, and the direction along which they are kept apart.
#pragma once

#include <optional>
#include <span>

#include "kernel/candidates.h"
#include "kernel/proximities.h"
#include "sim/contact/contact_properties.h"
#include "sim/contact/interaction.h"
#include "sim/contact/straight_surface.h"

namespace selvage::sim {

/// Kept while the repulsions sweep; the dynamics looks for the points again (swept_contacts.h).
struct RepulsionContact {
  PairKind kind = PairKind::kVf;
  std::int32_t first = 0, second = 0;  ///< the pair, as in PairProximity
  std::int32_t second_t0 = 0;          ///< that was met: a vertex slides on to other faces (swept_contacts.h)
  Interaction interaction;
  ContactProperties properties;
  PairVectors x_t0 = zero_vectors();
  Vec3 normal = Vec3::Zero();  ///< unit
  double distance = 0;         ///< of the points, along the normal, at the start of the step
  double mobility = 0;         ///< effective_mobility(interaction) > 0
  StraightFeature straight;    ///< of the body in it
  bool is_beyond = false;      ///< as in Across, when it was last looked at: it does not repel
};

/// A pair that is near at the start of the step. Nothing where no vertex that matters can move, or where the points
/// coincide.
[[nodiscard]] std::optional<RepulsionContact> make_contact(const PairProximity& pair,
                                                           const ContactProperties& properties, const Positions& V_t0,
                                                           std::span<const double> inverse_mass);

/// A pair that collides within the step: the points that meet, along the normal of the collision; where that does not
/// tell which side they come from, along the line between them at the start. Nothing as above. REQUIRES kVf or kEe.
[[nodiscard]] std::optional<RepulsionContact> make_contact(const Collision& collision,
                                                           const std::array<VertexId, 4>& vertices,
                                                           const ContactProperties& properties, const Positions& V_t0,
                                                           std::span<const double> inverse_mass);

/// Has it repel across what is straight (straight_surface.h) from now on, or finds it beyond that, at V_t0.
void turn_across(const StraightFeature& straight, const Positions& V_t0, RepulsionContact& contact);

/// Behind the others, which sort_pairs() brings into the order that Candidates has, each once.
void add_pair(const RepulsionContact& contact, Candidates& pairs);
void sort_pairs(Candidates& pairs);

struct RepulsionCount {
  std::int64_t repulsions = 0, frictions = 0;  ///< contacts that repelled, and rubbed
};

}  // namespace selvage::sim
