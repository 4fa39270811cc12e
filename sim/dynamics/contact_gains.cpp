#include "sim/dynamics/contact_gains.h"

#include "sim/base/parallel.h"
#include "sim/contact/cloth_sets.h"

namespace selvage::sim {
namespace {

/// So much of what there is counts as rounding: in cloth without gravity or loads sums of differences came to 3e-14
/// J/kg at most (tests/sim).
constexpr double kEnergyRounding = 0x1p-36;

}  // namespace

ContactGains::ContactGains(const SurfaceParts& parts, std::span<const RepulsionContact> contacts,
                           std::span<const double> inverse_mass, Eigen::Index cloth_count)
    : mass_kg_(static_cast<std::size_t>(cloth_count), 0) {
  ClothSets sets(parts, static_cast<VertexId>(cloth_count));
  for (const RepulsionContact& contact : contacts) sets.join(contact.interaction.vertices);
  for (VertexId i = 0; i < cloth_count; ++i) {
    const double w = inverse_mass[static_cast<std::size_t>(i)];
    set_.push_back(sets.set(i));
    vertex_kg_.push_back(w > 0 ? 1 / w : 0);
    mass_kg_[set_.back()] += vertex_kg_.back();
    const bool begins_block = i % kParallelBlock == 0;
    if (begins_block) first_run_.push_back(runs_.size());
    if (begins_block || runs_.back().set != set_.back()) runs_.push_back({i, i, set_.back(), 0});
    ++runs_.back().end;
  }
  clear();
}

void ContactGains::clear() { twice_j_.assign(mass_kg_.size(), 0); }

void ContactGains::add_motion(const LaneVectors& before, const LaneVectors& after) {
  parallel_blocks(std::ssize(set_), [&](Eigen::Index begin, Eigen::Index end) {
    std::size_t id = first_run_[static_cast<std::size_t>(begin / kParallelBlock)];
    for (; id < runs_.size() && runs_[id].begin < end; ++id) {
      Run& run = runs_[id];
      run.twice_j = 0;
      for (Eigen::Index i = run.begin; i < run.end; ++i) {
        const double from = before.row(i).squaredNorm(), to = after.row(i).squaredNorm();
        run.twice_j += vertex_kg_[static_cast<std::size_t>(i)] * (to - from - kEnergyRounding * from);
      }
    }
  });
  for (const Run& run : runs_) twice_j_[run.set] += run.twice_j;
}

bool ContactGains::exceed(double borne_j_kg) const {
  for (std::size_t i = 0; i < twice_j_.size(); ++i) {
    if (exceeds(i, borne_j_kg)) return true;
  }
  return false;
}

}  // namespace selvage::sim
