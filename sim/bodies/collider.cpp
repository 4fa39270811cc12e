#include "sim/bodies/collider.h"

#include "kernel/assert.h"

namespace selvage::sim {
namespace {

struct CountRows {
  Eigen::Index operator()(const Collider::Rigid& rigid) const { return rigid.local.rows(); }
  Eigen::Index operator()(const Collider::Animated& animated) const { return animated.local->first().x.rows(); }
  Eigen::Index operator()(const Attachment& attachment) const { return attachment.count(); }
};

struct Place {
  double time_s;
  const Positions& x;

  Positions operator()(const Collider::Rigid& rigid) const { return transform(rigid.linkage.at(time_s), rigid.local); }
  Positions operator()(const Collider::Animated& animated) const {
    return transform(animated.linkage.at(time_s), animated.local->at(time_s));
  }
  Positions operator()(const Attachment& attachment) const { return attachment.placed_on(x); }
};

}  // namespace

Collider::Collider(std::string name, std::vector<VertexId> vertices, Motion motion, double release_s)
    : name_(std::move(name)), vertices_(std::move(vertices)), motion_(std::move(motion)), release_s_(release_s) {
  SELVAGE_ASSERT(std::ssize(vertices_) == std::visit(CountRows{}, motion_));
}

const BodySequence* Collider::sequence() const {
  const auto* animated = std::get_if<Animated>(&motion_);
  return animated != nullptr ? animated->local.get() : nullptr;
}

Positions Collider::placed_at(double time_s, bool round_to_float32, const Positions& x) const {
  Positions placed = std::visit(Place{time_s, x}, motion_);
  if (round_to_float32) placed = placed.cast<float>().cast<double>().eval();
  return placed;
}

void Collider::place_at(double time_s, bool round_to_float32, Positions& x) const {
  const Positions placed = placed_at(time_s, round_to_float32, x);
  for (std::size_t i = 0; i < vertices_.size(); ++i) x.row(vertices_[i]) = placed.row(static_cast<Eigen::Index>(i));
}

}  // namespace selvage::sim
