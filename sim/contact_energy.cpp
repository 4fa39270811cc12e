#include "sim/contact_energy.h"

#include <algorithm>
#include <cmath>

namespace selvage::sim {
namespace {

/// Of the centre of mass of the two points, weighted as they move: a body's is that of the body.
Vec3 contact_velocity(const Interaction& interaction, const Positions& v) {
  Vec3 first = Vec3::Zero(), second = Vec3::Zero();
  double first_mobility = 0, second_mobility = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const double weight = interaction.weights[i];
    (weight > 0 ? first : second) += std::abs(weight) * v.row(interaction.vertices[i]).transpose();
    (weight > 0 ? first_mobility : second_mobility) += weight * weight * interaction.mobility[i];
  }
  return first + first_mobility / (first_mobility + second_mobility) * (second - first);
}

/// Of each part, at its smallest vertex, the mean of those of its contacts; zero where it has none.
std::vector<Vec3> velocities_met(const SurfaceParts& parts, VertexId cloth_count, const ResolvedStep& step) {
  std::vector<Vec3> sums(static_cast<std::size_t>(cloth_count), Vec3::Zero());
  std::vector<double> counts(sums.size());
  for (const auto contacts : {step.held, step.met}) {
    for (const RepulsionContact& contact : contacts) {
      const Vec3 velocity = contact_velocity(contact.interaction, step.v_before);
      for (const VertexId vertex : {contact.interaction.vertices.front(), contact.interaction.vertices.back()}) {
        const VertexId part = parts.part(vertex);
        if (part >= cloth_count) continue;
        sums[static_cast<std::size_t>(part)] += velocity;
        counts[static_cast<std::size_t>(part)] += 1;
      }
    }
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= std::max(counts[i], 1.0);
  return sums;
}

}  // namespace

std::vector<ContactEnergy> contact_energies(const SpringSystem& springs, const SurfaceParts& parts,
                                            std::span<const double> inverse_mass, const ResolvedStep& step,
                                            double fall_m_s) {
  const VertexId count = springs.vertex_count();
  std::vector<ContactEnergy> energies(static_cast<std::size_t>(count));
  const auto part_of = [&](VertexId i) { return static_cast<std::size_t>(parts.part(i)); };
  for (const Spring& spring : springs.springs()) {
    ContactEnergy& energy = energies[part_of(spring.a)];
    const double before_j = elastic_j(spring, step.x_before);
    energy.before_j += before_j;
    energy.gain_j += elastic_j(spring, step.x_after) - before_j;
  }
  const std::vector<Vec3> met = velocities_met(parts, count, step);
  for (VertexId i = 0; i < count; ++i) {
    const double w = inverse_mass[static_cast<std::size_t>(i)];
    if (!(w > 0)) continue;
    const double beside_m_s = (step.v_before.row(i).transpose() - met[part_of(i)]).norm();
    energies[part_of(i)].before_j += (beside_m_s * beside_m_s + fall_m_s * fall_m_s) / (2 * w);
  }
  return energies;
}

}  // namespace selvage::sim
