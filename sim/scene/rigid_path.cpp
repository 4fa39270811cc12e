#include "sim/scene/rigid_path.h"

#include <algorithm>
#include <numbers>

#include <Eigen/Geometry>

#include "kernel/assert.h"

namespace selvage::sim {

Eigen::Matrix3d rotation_matrix(const Vec3& rotation_deg) {
  const double angle_deg = rotation_deg.norm();
  if (angle_deg == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle_deg * (std::numbers::pi / 180), rotation_deg / angle_deg).toRotationMatrix();
}

RigidFrame frame_of(const Pose& pose) { return {rotation_matrix(pose.rotation_deg), pose.position_m}; }

RigidPath::RigidPath(std::vector<PoseKey> keys, Interpolation interpolation)
    : keys_(std::move(keys)), interpolation_(interpolation) {
  SELVAGE_ASSERT(!keys_.empty());
  for (std::size_t i = 1; i < keys_.size(); ++i) SELVAGE_ASSERT(keys_[i - 1].time_s < keys_[i].time_s);
}

Pose RigidPath::at(double time_s) const {
  const auto next = std::upper_bound(keys_.begin(), keys_.end(), time_s,
                                     [](double time, const PoseKey& key) { return time < key.time_s; });
  if (next == keys_.begin()) return keys_.front().pose;
  const PoseKey& from = *(next - 1);
  if (next == keys_.end() || time_s == from.time_s) return from.pose;
  const double span_s = next->time_s - from.time_s;
  const double u = (time_s - from.time_s) / span_s;
  const double s = interpolation_ == Interpolation::kLinear ? u : u * u * (3 - 2 * u);
  Pose pose;
  pose.position_m = from.pose.position_m + s * (next->pose.position_m - from.pose.position_m);
  pose.rotation_deg = from.pose.rotation_deg + s * (next->pose.rotation_deg - from.pose.rotation_deg);
  if (interpolation_ == Interpolation::kSpline) {
    const auto i = static_cast<std::size_t>(next - keys_.begin());
    const Pose rate_from = rate_at(i - 1), rate_next = rate_at(i);
    const double a = u * (1 - u) * (1 - u) * span_s, b = -u * u * (1 - u) * span_s;  // 0 at both keys, slopes 1 and 0
    pose.position_m += a * rate_from.position_m + b * rate_next.position_m;
    pose.rotation_deg += a * rate_from.rotation_deg + b * rate_next.rotation_deg;
  }
  return pose;
}

std::vector<double> RigidPath::keys_between(double t0_s, double t1_s) const {
  std::vector<double> times;
  for (const PoseKey& key : keys_) {
    if (t0_s < key.time_s && key.time_s < t1_s) times.push_back(key.time_s);
  }
  return times;
}

double RigidPath::turn_deg(double t0_s, double t1_s) const {
  std::vector<double> times = keys_between(t0_s, t1_s);
  times.push_back(t1_s);
  double turn_deg = 0;
  double from_s = t0_s;
  Vec3 from = at(t0_s).rotation_deg;
  for (const double time_s : times) {
    const Vec3 to = at(time_s).rotation_deg;
    if (interpolation_ == Interpolation::kSpline) {
      const double third_s = (time_s - from_s) / 3;
      const Vec3 out = third_s * turn_rate_deg_s(from_s), in = third_s * turn_rate_deg_s(time_s);
      turn_deg += out.norm() + (to - in - from - out).norm() + in.norm();
    } else {
      turn_deg += (to - from).norm();
    }
    from = to;
    from_s = time_s;
  }
  return turn_deg;
}

Vec3 RigidPath::turn_rate_deg_s(double time_s) const {
  if (time_s <= keys_.front().time_s || time_s >= keys_.back().time_s) return Vec3::Zero();
  const auto next = std::upper_bound(keys_.begin(), keys_.end(), time_s,
                                     [](double time, const PoseKey& key) { return time < key.time_s; });
  const auto i = static_cast<std::size_t>(next - keys_.begin());
  const PoseKey& from = keys_[i - 1];
  const double span_s = next->time_s - from.time_s;
  const double u = (time_s - from.time_s) / span_s;
  return 6 * u * (1 - u) / span_s * (next->pose.rotation_deg - from.pose.rotation_deg) +
         (1 - u) * (1 - 3 * u) * rate_at(i - 1).rotation_deg + u * (3 * u - 2) * rate_at(i).rotation_deg;
}

Pose RigidPath::rate_at(std::size_t i) const {
  if (i == 0 || i + 1 == keys_.size()) return {};
  const PoseKey &before = keys_[i - 1], &after = keys_[i + 1];
  const double span_s = after.time_s - before.time_s;
  return {(after.pose.position_m - before.pose.position_m) / span_s,
          (after.pose.rotation_deg - before.pose.rotation_deg) / span_s};
}

Positions transform(const RigidFrame& frame, const PositionsRef& local) {
  Positions placed(local.rows(), 3);
  for (Eigen::Index i = 0; i < local.rows(); ++i) {
    const Vec3 turned = frame.turn * local.row(i).transpose();
    placed.row(i) = (turned + frame.position_m).transpose();
  }
  return placed;
}

Positions place(const Pose& pose, const PositionsRef& local) { return transform(frame_of(pose), local); }

}  // namespace selvage::sim
