#include "sim/collider.h"

#include "kernel/assert.h"

namespace selvage::sim {

Collider::Collider(std::string name, std::vector<VertexId> vertices, Positions local, Linkage linkage, double release_s)
    : name_(std::move(name)),
      vertices_(std::move(vertices)),
      local_(std::move(local)),
      linkage_(std::move(linkage)),
      release_s_(release_s) {
  SELVAGE_ASSERT(static_cast<Eigen::Index>(vertices_.size()) == local_.rows());
}

Collider::Collider(std::string name, std::vector<VertexId> vertices, std::shared_ptr<const BodySequence> local,
                   Linkage linkage)
    : name_(std::move(name)),
      vertices_(std::move(vertices)),
      sequence_(std::move(local)),
      linkage_(std::move(linkage)) {
  SELVAGE_ASSERT(static_cast<Eigen::Index>(vertices_.size()) == sequence_->first().x.rows());
}

Positions Collider::placed_at(double time_s, bool round_to_float32) const {
  Positions placed = transform(linkage_.at(time_s), sequence_ ? sequence_->at(time_s) : local_);
  if (round_to_float32) placed = placed.cast<float>().cast<double>().eval();
  return placed;
}

void Collider::place_at(double time_s, bool round_to_float32, Positions& x) const {
  const Positions placed = placed_at(time_s, round_to_float32);
  for (std::size_t i = 0; i < vertices_.size(); ++i) x.row(vertices_[i]) = placed.row(static_cast<Eigen::Index>(i));
}

}  // namespace selvage::sim
