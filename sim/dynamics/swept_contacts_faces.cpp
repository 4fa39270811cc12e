// Where held contacts are: on which face, seen from which side, and when they end.
#include <algorithm>
#include <array>

#include "sim/dynamics/swept_contacts.h"

namespace selvage::sim {
namespace {

/// As far as another face must be nearer to count: above rounding, which has a vertex over an edge go back and forth;
/// on a flat surface it has slid over the border by 1.4e-3 of its distance then.
constexpr double kNearer = 1 - 1e-6;

constexpr std::array<std::size_t, 3> kCorners{1, 2, 3};  // of the face, in a vf pair

}  // namespace

/// The pairs' nearest points now, seen from the side on which they are while they are farther apart than the thickness;
/// what has passed through nearer than that is held on the side it came from. Contacts whose points are all on vertices
/// that cannot move do not act, nor do those whose points are not over what is straight between them.
SweptContacts::Refused SweptContacts::look_again(std::size_t id, const Reach& reach, const ContactMotion& motion,
                                                 PackMotion& read, LaneMask& lanes) {
  ContactPack& pack = packs_[id];
  const PairKind kind = kind_of(id);
  PackNearest nearest;
  find_nearest(kind, read, nearest);
  PackState& state = states_[id];
  const LaneMask were_beyond = lanes & state.beyond;
  state.beyond &= static_cast<LaneMask>(~lanes);
  LaneMask beyond = 0;
  if ((lanes & state.straight) != 0) beyond = lanes & turn_across(straight_[state.straight_at], motion.share, nearest);
  see_anew(nearest, were_beyond & ~beyond, pack);
  const LaneMask on_border = lanes & nearest.on_border;
  Slid slid;
  if (kind == PairKind::kVf && on_border != 0) slid = slide(id, on_border, reach, motion);
  if (slid.on != 0) read_motion(pack, read.lanes, motion, read);
  const LaneMask acting = slid.on | slid.through;
  beyond = static_cast<LaneMask>((beyond & ~acting) | slid.beyond);
  state.beyond |= beyond;
  const LaneMask left_out = slid.refused.out_of_reach | slid.refused.at_once | slid.cannot | beyond;
  lanes = take_nearest(nearest, static_cast<LaneMask>(lanes & ~(acting | left_out)), pack) | acting;
  return slid.refused;
}

/// Each of the lanes of vf on to the face on which its vertex is, seen from the side on which it is, as above.
SweptContacts::Slid SweptContacts::slide(std::size_t id, LaneMask lanes, const Reach& reach,
                                         const ContactMotion& motion) {
  Slid slid;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (!has_lane(lanes, lane)) continue;
    const std::size_t place = id * kLanes + lane;
    RepulsionContact now = contact_at(place);
    QuickProximity nearest = quick_proximity(now.kind, positions(now.interaction.vertices, motion));
    Answer answer = Answer::kYes;
    while (answer == Answer::kYes) answer = slides_on(now, nearest, reach, motion);
    if (answer == Answer::kOutOfReach) slid.refused.out_of_reach |= only_lane(lane);
    if (answer == Answer::kOutOfReach || now.second == contact_at(place).second) continue;
    const bool is_near = !(nearest.distance > now.properties.thickness_m);
    if (is_near && !(nearest.direction.dot(vector_in(packs_[place / kLanes].normal, lane)) > 0)) {
      slid.through |= only_lane(lane);
      continue;
    }
    now.interaction = make_interaction(now.kind, now.interaction.vertices, {}, held_.surface().inverse_mass);
    now.interaction.weights = nearest.weights;
    const StraightSurface& straight = now.straight.parts[StraightFeature::kWithin];  // where the vertex is a body's
    const Vec3 direction =
        ((1 - motion.share) * straight.direction(held_.V_t0()) + motion.share * straight.direction(held_.V_t1()))
            .normalized();
    const Across turned = across(straight, 1, direction, nearest.direction, nearest.distance);
    now.normal = turned.unit;
    if (turned.is_beyond || !(effective_mobility(now.interaction) > 0)) {
      (turned.is_beyond ? slid.beyond : slid.cannot) |= only_lane(lane);
      continue;
    }
    now.properties = held_.surface().properties.of(now.kind, now.first, now.second);
    contact_at(place) = now;
    set_lane(place);
    const LaneMask together = vf_.groups.together(id - vf_.first_pack);
    const bool clashes = has_lane(together, lane) && shares_vertex(place, together);
    (clashes ? slid.refused.at_once : slid.on) |= only_lane(lane);
  }
  return slid;
}

/// A vertex of cloth, with one of the others of its pack.
bool SweptContacts::shares_vertex(std::size_t place, LaneMask with) const {
  const ContactPack& pack = packs_[place / kLanes];
  const std::size_t own = place % kLanes;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    if (lane == own || !has_lane(with, lane)) continue;
    for (const auto& a : pack.vertices) {
      for (const auto& b : pack.vertices) {
        if (a[own] >= 0 && a[own] == b[lane]) return true;
      }
    }
  }
  return false;
}

/// Where the nearest point lies on the border of the face the surface goes on beyond it: to the face there that is
/// nearer. A walk from face to face ends, because the distance falls.
SweptContacts::Answer SweptContacts::slides_on(RepulsionContact& contact, QuickProximity& nearest, const Reach& reach,
                                               const ContactMotion& motion) const {
  if (contact.kind != PairKind::kVf) return Answer::kNo;
  const std::array<VertexId, 4> from = contact.interaction.vertices;
  const auto on_corner = [weights = nearest.weights](std::size_t k) { return weights[k] != 0; };
  const auto corner = std::ranges::find_if(kCorners, on_corner);
  if (corner == kCorners.end() || std::ranges::all_of(kCorners, on_corner)) return Answer::kNo;
  Answer slides = Answer::kNo;
  for (const FaceId id : held_.surface().faces.of(from[*corner])) {
    const std::array<VertexId, 3>& face = held_.surface().mesh.faces[static_cast<std::size_t>(id)];
    const auto holds = [&](VertexId v) { return std::ranges::find(face, v) != face.end(); };
    const auto is_beside = [&](std::size_t k) { return !on_corner(k) || holds(from[k]); };
    if (id == contact.second || holds(from[0]) || !std::ranges::all_of(kCorners, is_beside)) continue;
    if (!is_within(reach, face)) return Answer::kOutOfReach;
    const std::array<VertexId, 4> pair{from[0], face[0], face[1], face[2]};
    const QuickProximity other = quick_proximity(PairKind::kVf, positions(pair, motion));
    if (!(other.distance < kNearer * nearest.distance)) continue;
    nearest = other;
    contact.second = id;
    contact.interaction.vertices = pair;
    slides = Answer::kYes;
  }
  return slides;
}

bool SweptContacts::is_within(const Reach& reach, const std::array<VertexId, 3>& face) const {
  return std::ranges::all_of(face, [&](VertexId v) { return !held_.surface().is_cloth(v) || reach.has(v); });
}

PairVectors SweptContacts::positions(const std::array<VertexId, 4>& vertices, const ContactMotion& motion) const {
  PairVectors x;
  for (std::size_t i = 0; i < 4; ++i) {
    const VertexId vertex = vertices[i];
    if (held_.surface().is_cloth(vertex)) {
      x[i] = motion.x_t1.row(vertex) - motion.h * motion.v.row(vertex);
    } else {
      x[i] = held_.scripted_at(vertex, motion.share);
    }
  }
  return x;
}

}  // namespace selvage::sim
