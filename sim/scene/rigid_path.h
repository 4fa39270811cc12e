// A rigid motion given by keys: where a scripted body is at any time.
#pragma once

#include <vector>

#include "kernel/types.h"

namespace selvage::sim {

/// x_world = R x_local + position, with R the rotation by |rotation| degrees about the direction of `rotation`.
struct Pose {
  Vec3 position_m = Vec3::Zero();
  Vec3 rotation_deg = Vec3::Zero();  ///< rotation vector: axis times angle; (0, 0, 720) is two turns about z
};

struct PoseKey {
  double time_s = 0;
  Pose pose;
};

enum class Interpolation {
  kLinear,  ///< constant velocity between keys
  kSmooth,  ///< at rest at every key: s = u^2 (3 - 2u), the lowest-degree polynomial with zero end slopes
  kSpline,  ///< through the keys without a stop: cubic Hermite, the velocity at an inner key that of the chord between
            ///< its neighbours (Catmull-Rom), at rest at the first and the last
};

/// A pose as a map: x_outer = turn x_inner + position.
struct RigidFrame {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Vec3 position_m = Vec3::Zero();
};

/// The rotation matrix of a rotation vector in degrees; exactly the identity for the zero vector.
[[nodiscard]] Eigen::Matrix3d rotation_matrix(const Vec3& rotation_deg);
[[nodiscard]] RigidFrame frame_of(const Pose& pose);

class RigidPath {
 public:
  /// REQUIRES at least one key, times strictly increasing.
  RigidPath(std::vector<PoseKey> keys, Interpolation interpolation);
  /// Between keys position and rotation vector are interpolated per coordinate, so every intermediate motion is rigid.
  /// At a key's time the pose is the key's, bit for bit; before the first and after the last key it stands still.
  [[nodiscard]] Pose at(double time_s) const;
  /// The times of the keys between two times, these left out; in order.
  [[nodiscard]] std::vector<double> keys_between(double t0_s, double t1_s) const;
  /// How far it turns between two times, degrees: what its rotation vector goes, from key to key. Of a spline, which
  /// may go beyond its keys and come back, the length of the control polygons between them: no less.
  [[nodiscard]] double turn_deg(double t0_s, double t1_s) const;

 private:
  /// The change of pose per second at key i of a spline.
  [[nodiscard]] Pose rate_at(std::size_t i) const;
  /// What the rotation vector of a spline changes by per second, at any time.
  [[nodiscard]] Vec3 turn_rate_deg_s(double time_s) const;

  std::vector<PoseKey> keys_;
  Interpolation interpolation_;
};

/// Row i is turn local_i + position. The bits depend on the libm's sin and cos.
[[nodiscard]] Positions transform(const RigidFrame& frame, const PositionsRef& local);
[[nodiscard]] Positions place(const Pose& pose, const PositionsRef& local);

}  // namespace selvage::sim
