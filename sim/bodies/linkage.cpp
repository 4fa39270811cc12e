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

std::vector<double> Linkage::keys_between(double t0_s, double t1_s) const {
  std::vector<double> times;
  for (const Link& link : links_) {
    const std::vector<double> own = link.path.keys_between(t0_s, t1_s);
    times.insert(times.end(), own.begin(), own.end());
  }
  return times;
}

double Linkage::turn_deg(double t0_s, double t1_s) const {
  double turn_deg = 0;
  for (const Link& link : links_) turn_deg += link.path.turn_deg(t0_s, t1_s);
  return turn_deg;
}

}  // namespace selvage::sim
