#include "sim/bodies/linkage.h"

namespace selvage::sim {
namespace {

// x -> outer(inner(x))
RigidFrame compose(const RigidFrame& outer, const RigidFrame& inner) {
  return {outer.turn * inner.turn, outer.turn * inner.position_m + outer.position_m};
}

}  // namespace

Linkage::Linkage(const Pose& placement, RigidPath path) { links_.push_back({frame_of(placement), std::move(path)}); }

Linkage::Linkage(const Pose& placement, RigidPath path, const Linkage& parent) : Linkage(placement, std::move(path)) {
  links_.insert(links_.end(), parent.links_.begin(), parent.links_.end());
}

RigidFrame Linkage::at(double time_s) const {
  RigidFrame frame;
  for (const Link& link : links_) {
    frame = compose(link.placement, compose(frame_of(link.path.at(time_s)), frame));
  }
  return frame;
}

}  // namespace selvage::sim
