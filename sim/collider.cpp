#include "sim/collider.h"

#include "kernel/assert.h"

namespace selvage::sim {

Collider::Collider(std::string name, std::vector<VertexId> vertices, Local local, Linkage linkage, double release_s)
    : name_(std::move(name)),
      vertices_(std::move(vertices)),
      local_(std::move(local)),
      linkage_(std::move(linkage)),
      release_s_(release_s) {
  SELVAGE_ASSERT(std::ssize(vertices_) ==
                 (sequence() != nullptr ? sequence()->first().x : std::get<Positions>(local_)).rows());
}

const BodySequence* Collider::sequence() const {
  const auto* sequence = std::get_if<std::shared_ptr<const BodySequence>>(&local_);
  return sequence != nullptr ? sequence->get() : nullptr;
}

Positions Collider::placed_at(double time_s, bool round_to_float32) const {
  const RigidFrame frame = linkage_.at(time_s);
  Positions placed =
      sequence() != nullptr ? transform(frame, sequence()->at(time_s)) : transform(frame, std::get<Positions>(local_));
  if (round_to_float32) placed = placed.cast<float>().cast<double>().eval();
  return placed;
}

void Collider::place_at(double time_s, bool round_to_float32, Positions& x) const {
  const Positions placed = placed_at(time_s, round_to_float32);
  for (std::size_t i = 0; i < vertices_.size(); ++i) x.row(vertices_[i]) = placed.row(static_cast<Eigen::Index>(i));
}

}  // namespace selvage::sim
