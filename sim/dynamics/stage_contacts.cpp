#include "sim/dynamics/stage_contacts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "sim/base/parallel.h"
#include "sim/response/friction.h"

namespace selvage::sim {
namespace {

/// Of a contact, over what resists it in the stage's matrix. Three and ten times as much took 1.6 and 3.5 times the
/// iterations of conjugate gradients in sixteen sheets that drop on a ball, and not fewer solutions of the stage.
constexpr double kStiffness = 1;

}  // namespace

StageContacts::StageContacts(HeldContacts& held, const Positions& x, std::span<const double> inverse_mass,
                             std::span<const double> resistance_kg, const StageSpan& span)
    : held_(held), span_(span) {
  for (std::size_t i = 0; i < held.contacts().size(); ++i) {
    add_term(i, x, inverse_mass, resistance_kg);
    held.set_load(i, {}, false, false);
  }
  index_ends(x.rows());
  response_.resize(terms_.size());
  acts_.resize(terms_.size());
}

void StageContacts::add_term(std::size_t held_id, const Positions& x, std::span<const double> inverse_mass,
                             std::span<const double> resistance_kg) {
  const RepulsionContact& contact = held_.contacts()[held_id];
  const Interaction& interaction = contact.interaction;
  if (contact.is_beyond || lever_share(interaction) < 1) return;
  Term term;
  term.held = held_id;
  PairVectors at_start = zero_vectors(), scripted = zero_vectors();
  double yields = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const VertexId vertex = interaction.vertices[i];
    if (held_.surface().is_cloth(vertex)) {
      term.vertices[i] = vertex;
      at_start[i] = x.row(vertex);
      const auto row = static_cast<std::size_t>(vertex);
      if (inverse_mass[row] > 0) yields += interaction.weights[i] * interaction.weights[i] / resistance_kg[row];
    } else {
      term.vertices[i] = -1;
      at_start[i] = held_.scripted_at(vertex, span_.share_t0);
      scripted[i] = held_.scripted_at(vertex, span_.share_t1) - at_start[i];
    }
  }
  if (!(yields > 0)) return;
  term.stiffness_kg = kStiffness / yields;
  const double allowed_m = std::min(contact.properties.thickness_m, contact.distance);
  term.mobility_1_kg = effective_mobility(interaction) * interaction.inverse_mass_scale;
  const HeldContacts::Load load = held_.load(held_id);
  const double per_m_s2 = span_.h_s * span_.h_s / term.mobility_1_kg;
  term.borne[0] = per_m_s2 * load.along_m_s2;
  term.friction_static = contact.properties.friction_static;
  term.friction_kinetic = contact.properties.friction_kinetic;
  Eigen::Matrix3d& axes = term.axes;
  axes.row(0) = contact.normal;
  std::array<Eigen::Matrix3d, 4> slip;
  for (std::size_t i = 0; i < 4; ++i) slip[i] = interaction.weights[i] * Eigen::Matrix3d::Identity();
  if (term.friction_static > 0) {
    const Vec3 across = contact.normal.unitOrthogonal();
    axes.row(1) = across;
    axes.row(2) = contact.normal.cross(across);
    slip = slip_matrices(interaction, at_start);
    term.borne.tail<2>() = per_m_s2 * axes.bottomRows<2>() * load.friction_m_s2;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    term.jacobian[i] = axes * slip[i];
    term.jacobian[i].row(0) = interaction.weights[i] * contact.normal.transpose();
    if (term.vertices[i] < 0) term.start += term.jacobian[i] * scripted[i];
  }
  term.start[0] += relative(interaction, at_start).dot(contact.normal) - allowed_m;
  remembers_ = remembers_ || !term.borne.isZero(0);
  terms_.push_back(term);
}

void StageContacts::index_ends(Eigen::Index vertex_count) {
  begin_.assign(static_cast<std::size_t>(vertex_count) + 1, 0);
  for (const Term& term : terms_) {
    for (const VertexId vertex : term.vertices) {
      if (vertex >= 0) ++begin_[static_cast<std::size_t>(vertex) + 1];
    }
  }
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  ends_.resize(begin_.back());
  std::vector<std::size_t> next = begin_;
  for (std::uint32_t k = 0; k < terms_.size(); ++k) {
    for (std::uint32_t slot = 0; slot < 4; ++slot) {
      const VertexId vertex = terms_[k].vertices[slot];
      if (vertex < 0) continue;
      ends_[next[static_cast<std::size_t>(vertex)]++] = {k, terms_[k].jacobian[slot]};
    }
  }
}

std::span<const StageContacts::End> StageContacts::ends_at(Eigen::Index vertex) const {
  const auto row = static_cast<std::size_t>(vertex);
  return {ends_.data() + begin_[row], begin_[row + 1] - begin_[row]};
}

template <class Vectors>
Vec3 StageContacts::moved(const Term& term, const Vectors& u) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < 4; ++i) {
    if (term.vertices[i] >= 0) sum += term.jacobian[i] * u.row(term.vertices[i]).transpose();
  }
  return sum;
}

void StageContacts::look(const Positions& u) {
  parallel_each(std::ssize(terms_), [&](Eigen::Index k) {
    Term& term = terms_[static_cast<std::size_t>(k)];
    const double stiffness = term.stiffness_kg, radius = term.radius();
    term.asked = term.borne - stiffness * (term.start + moved(term, u));
    term.force.setZero();
    term.curvature.setZero();
    Acts& acts = acts_[static_cast<std::size_t>(k)];
    acts = Acts::kNot;
    if (term.asked[0] > 0) {
      acts = Acts::kAlongNormal;
      term.force[0] = term.asked[0];
      term.curvature(0, 0) = stiffness;
    }
    if (!(radius > 0)) return;
    acts = Acts::kAcross;
    const Eigen::Vector2d asked = term.asked.tail<2>();
    const double size = asked.norm();
    if (size <= radius) {
      term.force.tail<2>() = asked;
      term.curvature.bottomRightCorner<2, 2>() = stiffness * Eigen::Matrix2d::Identity();
    } else {
      const Eigen::Vector2d along = asked / size;
      term.force.tail<2>() = radius * along;
      term.curvature.bottomRightCorner<2, 2>() =
          stiffness * radius / size * (Eigen::Matrix2d::Identity() - along * along.transpose());
    }
  });
}

Eigen::RowVector3d StageContacts::force_at(Eigen::Index vertex) const {
  Vec3 sum = Vec3::Zero();
  for (const End& end : ends_at(vertex)) sum += end.jacobian.transpose() * terms_[end.term].force;
  return sum;
}

void StageContacts::add_diagonal(Eigen::Index vertex, SymmetricBlock& block) const {
  for (const End& end : ends_at(vertex)) {
    if (acts_[end.term] == Acts::kNot) continue;
    const Eigen::Matrix3d m = end.jacobian.transpose() * terms_[end.term].curvature * end.jacobian;
    block[0] += m(0, 0);
    block[1] += m(0, 1);
    block[2] += m(0, 2);
    block[3] += m(1, 1);
    block[4] += m(1, 2);
    block[5] += m(2, 2);
  }
}

void StageContacts::add_product(const LaneVectors& step, LaneVectors& result) const {
  parallel_each(std::ssize(terms_), [&](Eigen::Index k) {
    const auto at = static_cast<std::size_t>(k);
    const Term& term = terms_[at];
    if (acts_[at] == Acts::kNot) return;
    if (acts_[at] == Acts::kAlongNormal) {
      double along = 0;
      for (std::size_t i = 0; i < 4; ++i) {
        if (term.vertices[i] >= 0) along += term.jacobian[i].row(0).dot(step.row(term.vertices[i]));
      }
      response_[at] = {term.curvature(0, 0) * along, 0, 0};
    } else {
      response_[at] = term.curvature * moved(term, step);
    }
  });
  parallel_each(result.rows(), [&](Eigen::Index i) {
    Vec3 sum = Vec3::Zero();
    for (const End& end : ends_at(i)) {
      if (acts_[end.term] == Acts::kNot) continue;
      const Vec3& response = response_[end.term];
      if (acts_[end.term] == Acts::kAlongNormal) {
        sum += response[0] * end.jacobian.row(0).transpose();
      } else {
        sum += end.jacobian.transpose() * response;
      }
    }
    result.row(i) += sum;
  });
}

// As products with what changes, not as differences of potentials: small steps keep their digits.
void StageContacts::changes(const Positions& step, double share, std::vector<double>& result) const {
  result.resize(terms_.size());
  parallel_each(std::ssize(terms_), [&](Eigen::Index k) {
    const Term& term = terms_[static_cast<std::size_t>(k)];
    const Vec3 change = -share * term.stiffness_kg * moved(term, step);  // of what is asked for
    const Vec3 before = term.asked, after = before + change;
    double sum = 0;
    if (before[0] > 0 && after[0] > 0) {
      sum = change[0] * (before[0] + after[0]) / 2;
    } else {
      sum = (std::pow(std::max(0.0, after[0]), 2) - std::pow(std::max(0.0, before[0]), 2)) / 2;
    }
    const double radius = term.radius();
    if (radius > 0) {
      const Eigen::Vector2d both = before.tail<2>() + after.tail<2>();
      const double size_t0 = before.tail<2>().norm(), size_t1 = after.tail<2>().norm();
      if (size_t0 <= radius && size_t1 <= radius) {
        sum += change.tail<2>().dot(both) / 2;
      } else if (size_t0 > radius && size_t1 > radius) {
        sum += radius * change.tail<2>().dot(both) / (size_t0 + size_t1);
      } else {
        const auto outside = [&](double size) { return std::max(0.0, size - radius); };
        const auto inside = [&](double size) { return std::min(size, radius); };
        sum += radius * (outside(size_t1) - outside(size_t0)) +
               (inside(size_t1) - inside(size_t0)) * (inside(size_t1) + inside(size_t0)) / 2;
      }
    }
    result[static_cast<std::size_t>(k)] = sum / term.stiffness_kg;
  });
}

ForceChange StageContacts::update() {
  ForceChange found;
  for (Term& term : terms_) {
    Vec3 bears = term.asked;
    bears[0] = std::max(0.0, bears[0]);
    const double radius = (term.slides ? term.friction_kinetic : term.friction_static) * bears[0];
    const double size = bears.tail<2>().norm();
    term.is_at_border = size > radius;
    if (term.is_at_border) bears.tail<2>() *= radius / size;
    found.change_m = std::max(found.change_m, (bears - term.borne).norm() * term.mobility_1_kg);
    found.largest_m = std::max(found.largest_m, bears[0] * term.mobility_1_kg);
    term.borne = bears;
  }
  return found;
}

bool StageContacts::let_slide(double known_m) {
  bool changes = false;
  for (Term& term : terms_) {
    if (term.slides || !term.is_at_border || !(term.borne[0] > 0)) continue;
    if (!(term.friction_kinetic < term.friction_static)) continue;
    term.slides = true;
    const double kept = term.friction_kinetic / term.friction_static;
    const double change_m = (1 - kept) * term.borne.tail<2>().norm() * term.mobility_1_kg;
    if (change_m > known_m) changes = true;
    term.borne.tail<2>() *= kept;
  }
  return changes;
}

bool StageContacts::forget() {
  for (Term& term : terms_) {
    term.borne.setZero();
    term.is_at_border = term.slides = false;
  }
  return std::exchange(remembers_, false);
}

void StageContacts::finish() {
  for (const Term& term : terms_) {
    const Vec3 borne_m_s2 = term.mobility_1_kg / (span_.h_s * span_.h_s) * term.borne;
    const HeldContacts::Load load{borne_m_s2[0], term.axes.bottomRows<2>().transpose() * borne_m_s2.tail<2>()};
    held_.set_load(term.held, load, load.along_m_s2 > 0, !load.friction_m_s2.isZero(0));
  }
}

}  // namespace selvage::sim
