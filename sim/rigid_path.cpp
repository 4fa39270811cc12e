#include "sim/rigid_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "kernel/assert.h"

namespace selvage::sim {

Eigen::Matrix3d rotation_matrix(const Vec3& rotation_deg) {
  const double angle_deg = rotation_deg.norm();
  if (angle_deg == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle_deg * (std::numbers::pi / 180), rotation_deg / angle_deg).toRotationMatrix();
}

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
  const double u = (time_s - from.time_s) / (next->time_s - from.time_s);
  const double s = interpolation_ == Interpolation::kLinear ? u : u * u * (3 - 2 * u);
  Pose pose;
  pose.position_m = from.pose.position_m + s * (next->pose.position_m - from.pose.position_m);
  pose.rotation_deg = from.pose.rotation_deg + s * (next->pose.rotation_deg - from.pose.rotation_deg);
  return pose;
}

Positions place(const Pose& pose, const PositionsRef& local) {
  const Eigen::Matrix3d R = rotation_matrix(pose.rotation_deg);
  Positions placed(local.rows(), 3);
  for (Eigen::Index i = 0; i < local.rows(); ++i) {
    const Vec3 turned = R * local.row(i).transpose();
    placed.row(i) = (turned + pose.position_m).transpose();
  }
  return placed;
}

}  // namespace selvage::sim
