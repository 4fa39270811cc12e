// A perspective camera that is placed so that the cloth fills the picture.
#pragma once

#include "cli/render/surface.h"

namespace selvage::cli {

enum class UpAxis { kY, kZ };

struct View {
  double azimuth_deg = -55;   ///< of the camera about the up axis, from the first horizontal axis (x)
  double elevation_deg = 28;  ///< above the horizon
  UpAxis up = UpAxis::kZ;
};

/// The unit vector that points up.
[[nodiscard]] Vec3 up_of(const View& view);

class Camera {
 public:
  /// Stands so that the points of `stage` just fit a width by height picture with a margin. REQUIRES a point.
  Camera(const View& view, const Stage& stage, int width, int height);

  /// Right, down, depth along the line of sight, in length units.
  [[nodiscard]] Vec3 to_camera(const Vec3& point) const { return axes_ * (point - eye_); }
  /// Pixels. REQUIRES depth > 0.
  [[nodiscard]] Eigen::Vector2d to_screen(const Vec3& camera_point) const;
  /// Nothing nearer than this is drawn.
  [[nodiscard]] double near_depth() const { return near_depth_; }
  [[nodiscard]] const Vec3& eye() const { return eye_; }

 private:
  Eigen::Matrix3d axes_;
  Vec3 eye_;
  double focal_pixels_, near_depth_;
  Eigen::Vector2d middle_;
};

}  // namespace selvage::cli
