#include "sim/contact/repulsion_contact.h"

#include <algorithm>

namespace selvage::sim {
namespace {

std::optional<RepulsionContact> if_it_acts(RepulsionContact contact) {
  contact.mobility = effective_mobility(contact.interaction);
  if (!(contact.mobility > 0) || contact.normal.isZero(0)) return std::nullopt;
  return contact;
}

}  // namespace

std::optional<RepulsionContact> make_contact(const PairProximity& pair, const ContactProperties& properties,
                                             const Positions& V_t0, std::span<const double> inverse_mass) {
  RepulsionContact contact;
  contact.kind = pair.kind;
  contact.first = pair.first;
  contact.second = contact.second_t0 = pair.second;
  contact.interaction = make_interaction(pair.kind, pair.vertices, pair.proximity.weights, inverse_mass);
  contact.properties = properties;
  contact.x_t0 = gather(contact.interaction, V_t0);
  contact.normal = pair.proximity.normal;
  contact.distance = pair.proximity.distance;
  return if_it_acts(contact);
}

std::optional<RepulsionContact> make_contact(const Collision& collision, const std::array<VertexId, 4>& vertices,
                                             const ContactProperties& properties, const Positions& V_t0,
                                             std::span<const double> inverse_mass) {
  RepulsionContact contact;
  contact.kind = collision.kind;
  contact.first = collision.first;
  contact.second = contact.second_t0 = collision.second;
  contact.interaction = make_interaction(collision.kind, vertices, collision.ccd.weights, inverse_mass);
  contact.properties = properties;
  contact.x_t0 = gather(contact.interaction, V_t0);
  const Vec3 separation = relative(contact.interaction, contact.x_t0);
  const bool separates = separation.dot(collision.ccd.normal) > 0;
  contact.normal = separates ? collision.ccd.normal : Vec3(separation.stableNormalized());
  contact.distance = separation.dot(contact.normal);
  return if_it_acts(contact);
}

void turn_across(const StraightFeature& straight, const Positions& V_t0, RepulsionContact& contact) {
  contact.straight = straight;
  const std::array<double, 4>& weights = contact.interaction.weights;
  const StraightSurface& surface = straight.parts.at(straight.part(contact.kind, weights));
  if (surface.kind == StraightSurface::Kind::kCorner) return;  // with the distance as it was, to the bit
  const double extent_share = straight.extent_share(contact.kind, weights);
  const Across turned = across(surface, extent_share, surface.direction(V_t0), contact.normal, contact.distance);
  contact.is_beyond = turned.is_beyond;
  if (turned.is_beyond) return;
  contact.normal = turned.unit;
  contact.distance = relative(contact.interaction, contact.x_t0).dot(contact.normal);
}

void add_pair(const RepulsionContact& contact, Candidates& pairs) {
  if (contact.kind == PairKind::kVf) {
    pairs.vf.push_back({contact.first, contact.second});
  } else {
    pairs.ee.push_back({contact.first, contact.second});
  }
}

void sort_pairs(Candidates& pairs) {
  const auto sort_all = [](auto& of_kind) {
    std::ranges::sort(of_kind);
    of_kind.erase(std::unique(of_kind.begin(), of_kind.end()), of_kind.end());
  };
  sort_all(pairs.vf);
  sort_all(pairs.ee);
}

}  // namespace selvage::sim
