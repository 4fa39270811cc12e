// Rigid motions over a step: of an impact zone by its momentum (paper, 7.5), and of a body by its script.
#pragma once

#include <span>

#include "kernel/types.h"

namespace selvage::sim {

/// x -> center + translation + R (x - center).
struct RigidMotion {
  Vec3 center = Vec3::Zero();
  Vec3 translation = Vec3::Zero();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Zero();  ///< R - 1: exactly zero where nothing turns

  [[nodiscard]] Vec3 turned(const Vec3& x) const { return turn * (x - center); }  ///< what the turn moves x by
  [[nodiscard]] Vec3 displacement(const Vec3& x) const { return translation + turned(x); }
};

/// A zone turns by at most this angle, 120 degrees. On straight paths the zone is mapped by (1-t) 1 + t R, whose least
/// singular value is cos(angle / 2) >= 1/2: it stays regular, and distances shrink to no less than half on the way.
inline constexpr double kMaxZoneAngle = 2.0943951023931953;  // 2 pi / 3

/// The rigid motion with the linear and angular momentum of nodes at x that move by `displacement` (paper, 7.5):
/// omega = I^+ L, with the pseudo-inverse where the nodes lie on a line or in a point, then the exact rotation by
/// |omega|, cut at kMaxZoneAngle. The velocity field v_cm + omega x y keeps both momenta, and has no more energy than
/// before: it is its orthogonal projection. The chord of the rotation keeps linear momentum and is shorter than the
/// arc, so energy only falls; about the axis its angular momentum is sin(angle) / angle of L. REQUIRES finite input, at
/// least one node, inverse masses > 0.
[[nodiscard]] RigidMotion momentum_motion(std::span<const Vec3> x, std::span<const Vec3> displacement,
                                          std::span<const double> inverse_mass);

/// The rotation and translation that carry x_t0 to x_t1 best in least squares (Kabsch 1976); where the points leave a
/// rotation open (on a line, or one point), the least turn. Exact up to rounding for rigid scripts.
[[nodiscard]] RigidMotion best_fit_motion(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1);
/// Of all rows; as many.
[[nodiscard]] RigidMotion best_fit_motion(const Positions& x_t0, const Positions& x_t1);

}  // namespace selvage::sim
