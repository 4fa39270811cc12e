#include "sim/response/impulse.h"

#include <algorithm>

namespace selvage::sim {

ParallelUpdate::ParallelUpdate(VertexId vertex_count)
    : interaction_count_(static_cast<std::size_t>(vertex_count), 0),
      sum_(static_cast<std::size_t>(vertex_count), Vec3::Zero()) {}

void ParallelUpdate::apply(std::span<const PairChange> changes, double share_cap, StepMotion& motion) {
  for (const PairChange& pair : changes) {
    for (std::size_t i = 0; i < 4; ++i) {
      if (pair.change[i].isZero(0)) continue;
      if (interaction_count_[static_cast<std::size_t>(pair.vertices[i])]++ == 0) touched_.push_back(pair.vertices[i]);
    }
  }
  for (const PairChange& pair : changes) {
    std::int32_t most = 0;
    for (std::size_t i = 0; i < 4; ++i) {
      if (pair.change[i].isZero(0)) continue;
      most = std::max(most, interaction_count_[static_cast<std::size_t>(pair.vertices[i])]);
    }
    if (most == 0) continue;
    const double share = std::min(share_cap, 1.0 / most);
    for (std::size_t i = 0; i < 4; ++i) sum_[static_cast<std::size_t>(pair.vertices[i])] += share * pair.change[i];
  }
  for (const VertexId vertex : touched_) {
    const auto v = static_cast<std::size_t>(vertex);
    motion.move(vertex, motion.displacement().row(vertex).transpose() + sum_[v]);
    interaction_count_[v] = 0;
    sum_[v].setZero();
  }
  touched_.clear();
}

double collision_change(double gap_t0, double displacement, double tolerance) {
  const double inelastic = std::max(-displacement, 0.0);
  const double gap_t1 = gap_t0 + displacement + inelastic;
  return inelastic + std::max(kPushTolerances * tolerance - gap_t1, 0.0);
}

PairChange collision_impulse(const Collision& collision, const Interaction& interaction, const StepMotion& motion,
                             double tolerance) {
  const Vec3 separation = relative(interaction, gather(interaction, motion.V_t0()));
  // A normal that does not separate the points at t = 0 would push through the other side. Coincident points have no
  // line; any direction keeps the angular momentum then.
  const bool normal_separates = separation.dot(collision.ccd.normal) > 0;
  const bool along_line = !separation.isZero(0) && (is_closed(interaction) || !normal_separates);
  const Vec3 direction = along_line ? Vec3(separation.stableNormalized()) : collision.ccd.normal;
  const double gap_t0 = separation.dot(direction);
  const double displacement = relative(interaction, gather(interaction, motion.displacement())).dot(direction);
  return {interaction.vertices, distribute(interaction, collision_change(gap_t0, displacement, tolerance) * direction)};
}

}  // namespace selvage::sim
