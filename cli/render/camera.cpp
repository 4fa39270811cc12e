#include "cli/render/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace selvage::cli {
namespace {

constexpr double kFieldOfViewDeg = 28;  // vertical; a long lens keeps folds in proportion
constexpr int kFramingRounds = 4;
constexpr double kMargin = 0.94;  // part of the picture that the points may fill

}  // namespace

Vec3 up_of(const View& view) { return view.up == UpAxis::kY ? Vec3(0, 1, 0) : Vec3(0, 0, 1); }

Camera::Camera(const View& view, const Stage& stage, int width, int height) {
  const double degree = std::numbers::pi / 180;
  const Vec3 up = up_of(view), east(1, 0, 0), north = up.cross(east);
  const double azimuth = view.azimuth_deg * degree, elevation = view.elevation_deg * degree;
  const Vec3 backward =
      std::cos(elevation) * (std::cos(azimuth) * east + std::sin(azimuth) * north) + std::sin(elevation) * up;
  const Vec3 right = up.cross(backward).normalized();
  axes_.row(0) = right;
  axes_.row(1) = right.cross(backward);  // down
  axes_.row(2) = -backward;
  focal_pixels_ = height / 2.0 / std::tan(kFieldOfViewDeg / 2 * degree);
  middle_ = {width / 2.0, height / 2.0};

  const Eigen::Vector2d half(kMargin * width / 2, kMargin * height / 2);
  double distance = 2 * std::max(stage.bounds.radius(), std::numeric_limits<double>::min());
  eye_ = stage.bounds.center() + distance * backward;
  // Each round centres the points on the screen and then stands as near as the worst of them allows; the two depend on
  // each other only through perspective, so a few rounds suffice.
  for (int round = 0; round < kFramingRounds; ++round) {
    Eigen::Vector2d lower = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
    for (const Vec3& point : stage.points) {
      const Vec3 seen = to_camera(point);
      lower = lower.cwiseMin(seen.head<2>() / seen.z());
      upper = upper.cwiseMax(seen.head<2>() / seen.z());
    }
    const Eigen::Vector2d shift = distance / 2 * (lower + upper);
    eye_ += shift.x() * axes_.row(0).transpose() + shift.y() * axes_.row(1).transpose();
    double nearer = distance;  // the most that the eye can advance: |offset| f <= half (z - nearer) for all points
    for (const Vec3& point : stage.points) {
      const Vec3 seen = to_camera(point);
      nearer = std::min({nearer, seen.z() - std::abs(seen.x()) * focal_pixels_ / half.x(),
                         seen.z() - std::abs(seen.y()) * focal_pixels_ / half.y()});
    }
    nearer = std::min(nearer, 0.999 * distance);  // a single point would be met
    eye_ -= nearer * backward;
    distance -= nearer;
  }
  near_depth_ = distance / 100;
}

Eigen::Vector2d Camera::to_screen(const Vec3& camera_point) const {
  return middle_ + focal_pixels_ / camera_point.z() * camera_point.head<2>();
}

}  // namespace selvage::cli
