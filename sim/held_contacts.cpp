#include "sim/held_contacts.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "kernel/assert.h"
#include "sim/parallel.h"
#include "sim/quick_proximity.h"

namespace selvage::sim {
namespace {

/// Share of what a contact had to add that it remembers, of its friction as well. A column of twelve that is put down
/// in steps of 0.4 ms keeps every distance to a hundredth and comes to rest (tests/sim/held_contacts_test.cpp).
/// Measured: with nothing it sinks, and with all of it velocities, which last by themselves, are learnt as forces, and
/// it swings.
constexpr double kLearning = 0.5;

/// Factor on what is missing, in all sweeps but the last (successive over-relaxation); what was too much is taken back
/// as it is. Measured: 25 sheets that are laid over a ball keep 2.5 to 3 mm of 3 under four sweeps with it, 1.3 to 3
/// without, 0.8 to 3 under one (docs/simulator-speed.md).
constexpr double kOverRelaxation = 1.7;

/// As far as another face must be nearer to count: above rounding, which has a vertex over an edge go back and forth;
/// on a flat surface it has slid over the border by 1.4e-3 of its distance then.
constexpr double kNearer = 1 - 1e-6;

constexpr std::array<std::size_t, 3> kCorners{1, 2, 3};  // of the face, in a vf pair

void move_vertex(VertexId vertex, const Vec3& change, const MidstepMotion& step) {
  step.x_t1.row(vertex) += change.transpose();
  step.v.row(vertex) += change.transpose() / step.h;
}

FrictionCoefficients friction_of(const RepulsionContact& contact) {
  return {contact.properties.friction_static, contact.properties.friction_kinetic};
}

std::pair<std::int32_t, std::int32_t> pair_of(const ContactLoad& load) { return {load.vertex, load.face}; }

}  // namespace

HeldContacts::HeldContacts(const std::vector<RepulsionContact>& contacts, const std::vector<ContactLoad>& loads,
                           const HeldSurface& surface, const Positions& V_t0, const Positions& V_t1, double dt_s,
                           int sweeps)
    : surface_(surface), V_t0_(V_t0), V_t1_(V_t1), dt_s_(dt_s), sweeps_(sweeps) {
  lines_.resize(contacts.size());
  for (const PairKind kind : {PairKind::kVf, PairKind::kEe}) set_lines(kind, contacts);
  SELVAGE_ASSERT(vf_count_ + ee_.order().size() == lines_.size());
  parallel_each(static_cast<Eigen::Index>(vf_count_), [&](Eigen::Index at) {
    Line& line = lines_[static_cast<std::size_t>(at)];
    if (const ContactLoad* const load = load_of(line.contact, loads)) {
      line.load_m_s2 = load->acceleration_m_s2;
      line.friction_m_s2 = Vec3(load->friction_m_s2.data());
    }
  });
}

/// In the order in which they act. Groups are columns along gravity, in which a sweep passes a weight on through all
/// layers: as cubes the fifty of sim/scenes/stack.toml as a draft came as near as 0.6 mm of 3, as columns 1.7
/// (docs/simulator-speed.md).
void HeldContacts::set_lines(PairKind kind, const std::vector<RepulsionContact>& contacts) {
  const Vec3 down = surface_.gravity_m_s2.stableNormalized();
  std::vector<std::size_t> of_kind;
  std::vector<ContactGroups::Member> members;
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (contacts[i].kind != kind) continue;
    of_kind.push_back(i);
    std::array<VertexId, 4> vertices = contacts[i].interaction.vertices;
    const Vec3 at = V_t0_.row(vertices.front());
    std::ranges::replace_if(
        vertices, [&](VertexId v) { return !is_cloth(v); }, -1);
    members.push_back({vertices, at - down.dot(at) * down});
  }
  const bool is_vf = kind == PairKind::kVf;
  if (is_vf) vf_count_ = of_kind.size();
  ContactGroups& groups = is_vf ? vf_ : ee_;
  groups = ContactGroups(members, surface_.cloth_count);
  parallel_each(std::ssize(of_kind), [&](Eigen::Index at) {
    Line& line = lines_[static_cast<std::size_t>(at) + (is_vf ? 0 : vf_count_)];
    line.given = of_kind[groups.order()[static_cast<std::size_t>(at)]];
    line.contact = contacts[line.given];
    set(line);
  });
}

/// That of its pair; else that of the vertex on a face beside. Over an edge or a corner of the surface a vertex lies on
/// any of the faces there, and another may have been found than the one that bore it. Several may begin with one load:
/// what is too much they take back.
const ContactLoad* HeldContacts::load_of(const RepulsionContact& contact, const std::vector<ContactLoad>& loads) const {
  const auto begin = std::ranges::lower_bound(loads, contact.first, {}, &ContactLoad::vertex);
  const auto end = std::ranges::upper_bound(loads, contact.first, {}, &ContactLoad::vertex);
  auto load = std::find_if(begin, end, [&](const ContactLoad& l) { return l.face == contact.second; });
  if (load == end) load = std::find_if(begin, end, [&](const ContactLoad& l) { return touch(l.face, contact.second); });
  return load == end ? nullptr : &*load;
}

bool HeldContacts::touch(FaceId a, FaceId b) const {
  const auto& of_a = surface_.mesh.faces[static_cast<std::size_t>(a)];
  const auto& of_b = surface_.mesh.faces[static_cast<std::size_t>(b)];
  return std::ranges::find_first_of(of_a, of_b) != of_a.end();
}

void HeldContacts::set(Line& line) const {
  const Interaction& interaction = line.contact.interaction;
  const Vec3& normal = line.contact.normal;
  const PairVectors unit = distribute(interaction, normal);
  line.lever_share = lever_share(interaction);
  const auto cloth = std::ranges::find_if(interaction.vertices, [&](VertexId v) { return is_cloth(v); });
  SELVAGE_ASSERT(cloth != interaction.vertices.end());
  line.vertices.fill(*cloth);
  line.weights = line.shares = {};
  line.scripted_t0 = line.scripted_t1 = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const VertexId vertex = interaction.vertices[i];
    if (is_cloth(vertex)) {
      line.vertices[i] = vertex;
      line.weights[i] = interaction.weights[i];
      line.shares[i] = unit[i].dot(normal);
    } else {
      line.scripted_t0 += interaction.weights[i] * V_t0_.row(vertex).dot(normal);
      line.scripted_t1 += interaction.weights[i] * V_t1_.row(vertex).dot(normal);
    }
  }
}

void HeldContacts::bear(const MidstepMotion& step) {
  for (std::size_t at = vf_count_; at < lines_.size(); ++at) lines_[at].did = {};
  vf_.each(false, [&](std::size_t i, const Reach& reach) { return bear(lines_[i], reach, step); });
}

void HeldContacts::hold(const MidstepMotion& step) {
  for (int sweep = 1; sweep <= sweeps_; ++sweep) {
    const bool is_last = sweep == sweeps_;
    vf_.each(backwards_, [&](std::size_t i, const Reach& reach) { return hold(lines_[i], reach, is_last, step); });
    ee_.each(backwards_,
             [&](std::size_t i, const Reach& reach) { return hold(lines_[vf_count_ + i], reach, is_last, step); });
    backwards_ = !backwards_;
  }
  parallel_each(static_cast<Eigen::Index>(vf_count_),
                [&](Eigen::Index i) { learn(lines_[static_cast<std::size_t>(i)], step); });
}

/// What it bore in the last step, before anything else, where it is now.
bool HeldContacts::bear(Line& line, const Reach& reach, const MidstepMotion& step) const {
  line.did = {};
  if (!(line.load_m_s2 > 0)) return true;
  const Answer acts = look_again(line, reach, step);
  if (acts == Answer::kOutOfReach) return false;
  if (acts == Answer::kNo) {
    line.load_m_s2 = 0;
    line.friction_m_s2.setZero();
    return true;
  }
  if (line.lever_share < 1) return true;  // pushed once, in the last sweep
  push(line, line.load_m_s2 * step.h * step.h, step);
  const RepulsionContact& contact = line.contact;
  if (!(line.did.pressed > 0)) return true;
  const Vec3 friction_m = step.h * step.h * line.friction_m_s2;
  move(line,
       begin_friction(contact.interaction, contact.x_t0, contact.normal, friction_of(contact), friction_m, line.did),
       step);
  return true;
}

/// What is missing; or takes back what was too much, down to nothing.
bool HeldContacts::hold(Line& line, const Reach& reach, bool is_last, const MidstepMotion& step) const {
  double change = excess(line, step);
  if (!(line.load_m_s2 > 0 || line.did.pressed > 0)) {  // else it has been looked at in this step
    if (!(change > 0)) return true;
    const Answer acts = look_again(line, reach, step);
    if (acts == Answer::kOutOfReach) return false;
    if (acts == Answer::kNo) return true;
    change = excess(line, step);
  }
  if (!is_last && line.lever_share < 1) return true;  // once, or the limit of its lever would not hold
  push(line, change > 0 ? (is_last ? 1 : kOverRelaxation) * change : std::max(change, -line.did.pressed), step);
  if (is_last) {
    rub(line, step);
    line.repelled = line.repelled || line.did.pressed > 0;
    line.rubbed = line.rubbed || line.did.rubbed != Vec3::Zero();
  }
  return true;
}

/// Friction where the vertex can move: cloth that the edge of a box carried by a vertex of its own swung about that by
/// 0.7 mm for ever, and rests since the vertices of bodies do not remember (docs/simulator-speed.md).
void HeldContacts::learn(Line& line, const MidstepMotion& step) {
  if (!(line.did.pressed > 0 && line.lever_share == 1)) {
    line.load_m_s2 = 0;
    line.friction_m_s2.setZero();
    return;
  }
  const double squared_s2 = step.h * step.h;
  const double now_m_s2 = std::min(line.did.pressed / squared_s2, std::numeric_limits<double>::max());
  Vec3 friction_m_s2 = effective_mobility(line.contact.interaction) / squared_s2 * line.did.rubbed;
  if (!friction_m_s2.allFinite() || line.contact.interaction.mobility[0] == 0) friction_m_s2.setZero();
  line.load_m_s2 += kLearning * (now_m_s2 - line.load_m_s2);
  line.friction_m_s2 = (1 - kLearning) * line.friction_m_s2 + kLearning * friction_m_s2;
}

void HeldContacts::push(Line& line, double change, const MidstepMotion& step) {
  line.did.pressed += line.lever_share * change;
  for (std::size_t i = 0; i < 4; ++i) {
    if (line.shares[i] != 0) move_vertex(line.vertices[i], change * line.shares[i] * line.contact.normal, step);
  }
}

/// How much of the approach in this step is too much; below 0 how much more there may be.
double HeldContacts::excess(const Line& line, const MidstepMotion& step) const {
  const Vec3& normal = line.contact.normal;
  const double scripted = line.scripted_t1 - line.scripted_t0;
  double distance = line.scripted_t0 + step.share * scripted;
  for (std::size_t i = 0; i < 4; ++i) distance += line.weights[i] * step.x_t1.row(line.vertices[i]).dot(normal);
  const double overlap = line.contact.properties.thickness_m - distance;
  if (line.did.pressed == 0 && !(overlap > 0)) return overlap;
  double approach = -step.h / dt_s_ * scripted;
  for (std::size_t i = 0; i < 4; ++i) approach -= step.h * line.weights[i] * step.v.row(line.vertices[i]).dot(normal);
  return std::min(overlap, approach);
}

/// The pair's nearest points now, seen from the side on which they are while they are farther apart than the thickness;
/// what has passed through nearer than that is held on the side it came from. Whether the line can act: not where the
/// points are all on vertices that cannot move.
HeldContacts::Answer HeldContacts::look_again(Line& line, const Reach& reach, const MidstepMotion& step) const {
  RepulsionContact now = line.contact;
  QuickProximity nearest = quick_proximity(now.kind, positions(now.interaction.vertices, step));
  Answer slides = Answer::kYes;
  while (slides == Answer::kYes) slides = slides_on(now, nearest, reach, step);
  if (slides == Answer::kOutOfReach) return slides;
  const bool is_near = !(nearest.distance > now.properties.thickness_m);
  if (is_near && !(nearest.direction.dot(line.contact.normal) > 0)) return Answer::kYes;
  if (now.second != line.contact.second) {
    now.interaction = make_interaction(now.kind, now.interaction.vertices, {}, surface_.inverse_mass);
    now.properties = surface_.properties.of(now.kind, now.first, now.second);
  }
  now.x_t0 = positions(now.interaction.vertices, step);
  now.normal = nearest.direction;
  now.interaction.weights = nearest.weights;
  if (!(effective_mobility(now.interaction) > 0)) return Answer::kNo;
  line.contact = now;
  set(line);
  return Answer::kYes;
}

/// Where the nearest point lies on the border of the face the surface goes on beyond it: to the face there that is
/// nearer. A walk from face to face ends, because the distance falls.
HeldContacts::Answer HeldContacts::slides_on(RepulsionContact& contact, QuickProximity& nearest, const Reach& reach,
                                             const MidstepMotion& step) const {
  if (contact.kind != PairKind::kVf) return Answer::kNo;
  const std::array<VertexId, 4> from = contact.interaction.vertices;
  const auto on_corner = [weights = nearest.weights](std::size_t k) { return weights[k] != 0; };
  const auto corner = std::ranges::find_if(kCorners, on_corner);
  if (corner == kCorners.end() || std::ranges::all_of(kCorners, on_corner)) return Answer::kNo;
  Answer slides = Answer::kNo;
  for (const FaceId id : surface_.faces.of(from[*corner])) {
    const std::array<VertexId, 3>& face = surface_.mesh.faces[static_cast<std::size_t>(id)];
    const auto holds = [&](VertexId v) { return std::ranges::find(face, v) != face.end(); };
    const auto is_beside = [&](std::size_t k) { return !on_corner(k) || holds(from[k]); };
    if (id == contact.second || holds(from[0]) || !std::ranges::all_of(kCorners, is_beside)) continue;
    if (!is_within(reach, face)) return Answer::kOutOfReach;
    const std::array<VertexId, 4> pair{from[0], face[0], face[1], face[2]};
    const QuickProximity other = quick_proximity(PairKind::kVf, positions(pair, step));
    if (!(other.distance < kNearer * nearest.distance)) continue;
    nearest = other;
    contact.second = id;
    contact.interaction.vertices = pair;
    slides = Answer::kYes;
  }
  return slides;
}

bool HeldContacts::is_within(const Reach& reach, const std::array<VertexId, 3>& face) const {
  return std::ranges::all_of(face, [&](VertexId v) { return !is_cloth(v) || reach.has(v); });
}

/// What it rubbed before in this step is found anew: its direction is that of the slip without it, its cone that of
/// what presses now.
void HeldContacts::rub(Line& line, const MidstepMotion& step) const {
  if (!(line.did.pressed > 0) && line.did.rubbed == Vec3::Zero()) return;
  const RepulsionContact& contact = line.contact;
  const bool had_begun = line.did.rubbed != Vec3::Zero();
  PairVectors change = take_back(contact.interaction, line.did);
  PairVectors displacement = displacements(line, step);
  for (std::size_t i = 0; i < 4; ++i) displacement[i] += change[i];
  const auto friction =
      friction_change(contact.interaction, contact.x_t0, displacement, contact.normal, friction_of(contact), line.did);
  if (friction) {
    for (std::size_t i = 0; i < 4; ++i) change[i] += (*friction)[i];
  }
  if (friction || had_begun) move(line, change, step);
}

void HeldContacts::move(const Line& line, const PairVectors& changes, const MidstepMotion& step) const {
  for (std::size_t i = 0; i < 4; ++i) {
    const VertexId vertex = line.contact.interaction.vertices[i];
    if (is_cloth(vertex)) move_vertex(vertex, changes[i], step);
  }
}

PairVectors HeldContacts::positions(const std::array<VertexId, 4>& vertices, const MidstepMotion& step) const {
  PairVectors x;
  for (std::size_t i = 0; i < 4; ++i) {
    const VertexId vertex = vertices[i];
    if (is_cloth(vertex)) {
      x[i] = step.x_t1.row(vertex) - step.h * step.v.row(vertex);
    } else {
      x[i] = V_t0_.row(vertex) + (step.share - step.h / dt_s_) * (V_t1_.row(vertex) - V_t0_.row(vertex));
    }
  }
  return x;
}

PairVectors HeldContacts::displacements(const Line& line, const MidstepMotion& step) const {
  PairVectors moved;
  for (std::size_t i = 0; i < 4; ++i) {
    const VertexId vertex = line.contact.interaction.vertices[i];
    if (is_cloth(vertex)) {
      moved[i] = step.h * step.v.row(vertex);
    } else {
      moved[i] = step.h / dt_s_ * (V_t1_.row(vertex) - V_t0_.row(vertex));
    }
  }
  return moved;
}

void HeldContacts::bore(std::size_t i, double load_m_s2, bool rubbed) {
  Line& line = lines_[i];
  line.load_m_s2 = load_m_s2;
  line.friction_m_s2.setZero();
  line.repelled = line.repelled || load_m_s2 > 0;
  line.rubbed = line.rubbed || rubbed;
}

std::vector<RepulsionContact> HeldContacts::contacts() const {
  std::vector<RepulsionContact> result(lines_.size());
  parallel_each(std::ssize(lines_), [&](Eigen::Index i) {
    const Line& line = lines_[static_cast<std::size_t>(i)];
    RepulsionContact& contact = result[line.given];
    contact = line.contact;
    contact.x_t0 = gather(contact.interaction, V_t0_);
    contact.distance = relative(contact.interaction, contact.x_t0).dot(contact.normal);
    contact.mobility = effective_mobility(contact.interaction);
  });
  return result;
}

RepulsionCount HeldContacts::count() const {
  return {std::ranges::count_if(lines_, &Line::repelled), std::ranges::count_if(lines_, &Line::rubbed)};
}

std::vector<ContactLoad> HeldContacts::loads() const {
  std::vector<ContactLoad> result;
  for (std::size_t at = 0; at < vf_count_; ++at) {
    const Line& line = lines_[at];
    if (!(line.load_m_s2 > 0)) continue;
    const Vec3& friction = line.friction_m_s2;
    result.push_back(
        {line.contact.first, line.contact.second, line.load_m_s2, {friction.x(), friction.y(), friction.z()}});
  }
  // A pair that collided while it was held is held twice; what both bear, the first does, and the other takes back.
  std::ranges::stable_sort(result, {}, pair_of);
  const auto same = [](const ContactLoad& a, const ContactLoad& b) { return pair_of(a) == pair_of(b); };
  result.erase(std::unique(result.begin(), result.end(), same), result.end());
  return result;
}

}  // namespace selvage::sim
