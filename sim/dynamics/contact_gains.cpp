#include "sim/dynamics/contact_gains.h"

#include <algorithm>

#include "sim/base/disjoint_sets.h"
#include "sim/base/parallel.h"

namespace selvage::sim {
namespace {

/// So much of what there is counts as rounding: in cloth without gravity or loads sums of differences came to 3e-14
/// J/kg at most (tests/sim).
constexpr double kEnergyRounding = 0x1p-36;

}  // namespace

ContactGains::ContactGains(const SurfaceParts& parts, std::span<const RepulsionContact> contacts,
                           std::span<const double> inverse_mass, Eigen::Index cloth_count)
    : inverse_mass_(inverse_mass), mass_kg_(static_cast<std::size_t>(cloth_count), 0) {
  DisjointSets<VertexId> sets(static_cast<VertexId>(cloth_count));
  for (const RepulsionContact& contact : contacts) {
    VertexId one = -1;
    for (const VertexId vertex : contact.interaction.vertices) {
      if (vertex >= cloth_count) continue;
      if (one >= 0) sets.join(parts.part(one), parts.part(vertex));
      one = vertex;
    }
  }
  for (VertexId i = 0; i < cloth_count; ++i) {
    set_.push_back(static_cast<std::size_t>(sets.root(parts.part(i))));
    const double w = inverse_mass[static_cast<std::size_t>(i)];
    if (w > 0) mass_kg_[set_.back()] += 1 / w;
  }
  clear();
}

void ContactGains::clear() { twice_j_.assign(mass_kg_.size(), 0); }

void ContactGains::add_motion(const LaneVectors& before, const LaneVectors& after) {
  of_vertex_j_.resize(set_.size());
  parallel_each(std::ssize(set_), [&](Eigen::Index i) {
    const double w = inverse_mass_[static_cast<std::size_t>(i)];
    const double from = before.row(i).squaredNorm(), to = after.row(i).squaredNorm();
    of_vertex_j_[static_cast<std::size_t>(i)] = w > 0 ? (to - from - kEnergyRounding * from) / w : 0;
  });
  for (std::size_t i = 0; i < set_.size(); ++i) twice_j_[set_[i]] += of_vertex_j_[i];
}

bool ContactGains::exceed(double borne_j_kg) const {
  for (std::size_t i = 0; i < twice_j_.size(); ++i) {
    if (exceeds(i, borne_j_kg)) return true;
  }
  return false;
}

}  // namespace selvage::sim
