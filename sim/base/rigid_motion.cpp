#include "sim/base/rigid_motion.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>

#include "sim/base/cross_matrix.h"
#include "sim/base/power_of_two.h"
#include "sim/base/pseudo_inverse.h"

namespace selvage::sim {
namespace {

// Prefers no turn about axes for which the points ask for none. 100 times the rounding of the covariance, so that the
// preference wins there; where the second largest extent is 1/100 of the largest it shifts the angle by 10^-10.
constexpr double kLeastTurnWeight = 1e-14;

double largest_coordinate(std::span<const Vec3> vectors) {
  double largest = 0;
  for (const Vec3& v : vectors) largest = std::max(largest, v.cwiseAbs().maxCoeff());
  return largest;
}

/// y = (x - mean) / scale.
struct Centered {
  std::vector<Vec3> y;
  Vec3 mean;
  double scale;
};
/// With the weighted mean, and a power of two that leaves no coordinate above 1.
Centered centered(std::span<const Vec3> x, std::span<const double> share) {
  Centered result{{x.begin(), x.end()}, Vec3::Zero(), 1};
  for (std::size_t i = 0; i < x.size(); ++i) result.mean += share[i] * (x[i] - x[0]);
  result.mean += x[0];
  for (Vec3& y : result.y) y -= result.mean;
  result.scale = power_of_two_above(largest_coordinate(result.y));
  for (Vec3& y : result.y) y /= result.scale;
  return result;
}

template <class Function>
Vec3 weighted_sum(std::span<const double> weights, std::span<const Vec3> vectors, const Function& function) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < vectors.size(); ++i) sum += weights[i] * function(vectors[i]);
  return sum;
}

/// Masses over their sum.
std::vector<double> mass_shares(std::span<const double> inverse_mass) {
  const double least_inverse = *std::ranges::min_element(inverse_mass);  // of the heaviest node
  std::vector<double> share;
  double sum = 0;
  for (const double inverse : inverse_mass) {
    share.push_back(least_inverse / inverse);
    sum += share.back();
  }
  for (double& s : share) s /= sum;
  return share;
}

}  // namespace

RigidMotion momentum_motion(std::span<const Vec3> x, std::span<const Vec3> displacement,
                            std::span<const double> inverse_mass) {
  const std::vector<double> mass = mass_shares(inverse_mass);
  const Centered position = centered(x, mass);
  const Centered motion = centered(displacement, mass);
  // The mean is rounded as displacement[0] is, of which a light node's may be the largest of all by far.
  const Vec3 rest = weighted_sum(mass, displacement, [&](const Vec3& d) -> Vec3 { return d - motion.mean; });
  RigidMotion result{position.mean, motion.mean + rest};
  Vec3 angular_momentum = Vec3::Zero();
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec3& y = position.y[i];
    angular_momentum += mass[i] * y.cross(motion.y[i]);
    inertia += mass[i] * (y.squaredNorm() * Eigen::Matrix3d::Identity() - y * y.transpose());
  }
  const Vec3 omega = pseudo_inverse(inertia) * angular_momentum;  // in units of motion.scale / position.scale
  const double speed = omega.norm();
  if (!(speed > 0)) return result;
  const double angle = std::min(speed * (motion.scale / position.scale), kMaxZoneAngle);
  const Eigen::Matrix3d axis = cross_matrix(omega / speed);
  const double sine_of_half = std::sin(angle / 2);
  // Rodrigues: R - 1 = sin(angle) [a] + (1 - cos(angle)) [a]^2, with 1 - cos written without cancellation.
  result.turn = std::sin(angle) * axis + 2 * sine_of_half * sine_of_half * axis * axis;
  // About the true center the turn would not move the mean. About the rounded one it does, by a position's rounding,
  // which far from the origin was 10^-10 of the momentum, and as every product is rounded.
  result.translation -= weighted_sum(mass, x, [&](const Vec3& node) { return result.turned(node); });
  return result;
}

RigidMotion best_fit_motion(std::span<const Vec3> x_t0, std::span<const Vec3> x_t1) {
  const std::vector<double> share(x_t0.size(), 1.0 / static_cast<double>(x_t0.size()));
  const Centered start = centered(x_t0, share);
  const Centered end = centered(x_t1, share);
  RigidMotion result{start.mean, end.mean - start.mean};
  if (start.y == end.y && start.scale == end.scale) return result;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < x_t0.size(); ++i) covariance += end.y[i] * start.y[i].transpose();
  const double size = covariance.norm();
  covariance += (size > 0 ? kLeastTurnWeight * size : 1.0) * Eigen::Matrix3d::Identity();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double handedness = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  const Vec3 proper(1, 1, handedness);
  result.turn = svd.matrixU() * proper.asDiagonal() * svd.matrixV().transpose() - Eigen::Matrix3d::Identity();
  return result;
}

RigidMotion best_fit_motion(const Positions& x_t0, const Positions& x_t1) {
  std::vector<Vec3> start, end;
  for (Eigen::Index i = 0; i < x_t0.rows(); ++i) {
    start.emplace_back(x_t0.row(i));
    end.emplace_back(x_t1.row(i));
  }
  return best_fit_motion(start, end);
}

}  // namespace selvage::sim
