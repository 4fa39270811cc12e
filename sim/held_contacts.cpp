#include "sim/held_contacts.h"

#include <algorithm>

#include "sim/quick_proximity.h"

namespace selvage::sim {
namespace {

void move(VertexId vertex, const Vec3& change, const MidstepMotion& step) {
  step.x_t1.row(vertex) += change.transpose();
  step.v.row(vertex) += change.transpose() / step.h;
}

}  // namespace

HeldContacts::HeldContacts(const std::vector<RepulsionContact>& contacts, const Positions& V_t0, const Positions& V_t1,
                           Eigen::Index cloth_count, double dt_s)
    : V_t0_(V_t0), V_t1_(V_t1), cloth_count_(cloth_count), dt_s_(dt_s) {
  lines_.reserve(contacts.size());
  for (const RepulsionContact& contact : contacts) {
    (contact.kind == PairKind::kVf ? vf_ : ee_).push_back(lines_.size());
    lines_.push_back({.contact = contact});
    set(lines_.back());
  }
}

void HeldContacts::set(Line& line) const {
  const Interaction& interaction = line.contact.interaction;
  const Vec3& normal = line.contact.normal;
  const PairVectors unit = distribute(interaction, normal);
  line.scripted_t0 = line.scripted_t1 = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const VertexId vertex = interaction.vertices[i];
    if (vertex < cloth_count_) {
      line.vertices[i] = vertex;
      line.weights[i] = interaction.weights[i];
      line.shares[i] = unit[i].dot(normal);
    } else {
      line.scripted_t0 += interaction.weights[i] * V_t0_.row(vertex).dot(normal);
      line.scripted_t1 += interaction.weights[i] * V_t1_.row(vertex).dot(normal);
    }
  }
}

void HeldContacts::hold(const MidstepMotion& step) {
  for (const std::vector<std::size_t>* kind : {&vf_, &ee_}) {
    for (std::size_t k = 0; k < kind->size(); ++k) {
      hold(lines_[(*kind)[backwards_ ? kind->size() - 1 - k : k]], step);
    }
  }
  backwards_ = !backwards_;
}

void HeldContacts::hold(Line& line, const MidstepMotion& step) const {
  if (!(push(line, step) > 0)) return;
  look_again(line, step);
  const double change = push(line, step);
  if (!(change > 0)) return;
  line.repelled = true;
  for (std::size_t i = 0; i < 4; ++i) {
    if (line.shares[i] != 0) move(line.vertices[i], change * line.shares[i] * line.contact.normal, step);
  }
  rub(line, change, step);
}

/// How much of the approach in this step is too much; where there is none, at most 0.
double HeldContacts::push(const Line& line, const MidstepMotion& step) const {
  const Vec3& normal = line.contact.normal;
  const double scripted = line.scripted_t1 - line.scripted_t0;
  double distance = line.scripted_t0 + step.share * scripted;
  for (std::size_t i = 0; i < 4; ++i) distance += line.weights[i] * step.x_t1.row(line.vertices[i]).dot(normal);
  const double overlap = line.contact.properties.thickness_m - distance;
  if (!(overlap > 0)) return 0;
  double approach = -step.h / dt_s_ * scripted;
  for (std::size_t i = 0; i < 4; ++i) approach -= step.h * line.weights[i] * step.v.row(line.vertices[i]).dot(normal);
  return std::min(overlap, approach);
}

/// The pair's nearest points now; features that have passed through each other are left to the collision step.
void HeldContacts::look_again(Line& line, const MidstepMotion& step) const {
  RepulsionContact& contact = line.contact;
  const PairVectors x = positions(line, step);
  const QuickProximity quick = quick_proximity(contact.kind, x);
  if (!(quick.direction.dot(contact.normal) > 0)) return;
  contact.x_t0 = x;
  contact.normal = quick.direction;
  contact.interaction.weights = quick.weights;
  set(line);
}

void HeldContacts::rub(Line& line, double push, const MidstepMotion& step) const {
  const RepulsionContact& contact = line.contact;
  const Interaction& interaction = contact.interaction;
  FrictionLoad load{push};
  const FrictionCoefficients friction{contact.properties.friction_static, contact.properties.friction_kinetic};
  const auto change =
      friction_change(interaction, contact.x_t0, displacements(line, step), contact.normal, friction, load);
  if (!change) return;
  line.rubbed = true;
  for (std::size_t i = 0; i < 4; ++i) {
    if (interaction.vertices[i] < cloth_count_) move(interaction.vertices[i], (*change)[i], step);
  }
}

PairVectors HeldContacts::positions(const Line& line, const MidstepMotion& step) const {
  PairVectors x;
  for (std::size_t i = 0; i < 4; ++i) {
    const VertexId vertex = line.contact.interaction.vertices[i];
    if (vertex < cloth_count_) {
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
    if (vertex < cloth_count_) {
      moved[i] = step.h * step.v.row(vertex);
    } else {
      moved[i] = step.h / dt_s_ * (V_t1_.row(vertex) - V_t0_.row(vertex));
    }
  }
  return moved;
}

std::vector<RepulsionContact> HeldContacts::contacts() const {
  std::vector<RepulsionContact> result;
  for (const Line& line : lines_) {
    RepulsionContact contact = line.contact;
    contact.x_t0 = gather(contact.interaction, V_t0_);
    contact.distance = relative(contact.interaction, contact.x_t0).dot(contact.normal);
    contact.mobility = effective_mobility(contact.interaction);
    result.push_back(contact);
  }
  return result;
}

RepulsionCount HeldContacts::count() const {
  return {std::ranges::count_if(lines_, &Line::repelled), std::ranges::count_if(lines_, &Line::rubbed)};
}

}  // namespace selvage::sim
