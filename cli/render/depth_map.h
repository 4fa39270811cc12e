// What a distant light sees: the depth of the surface along its direction, for shadows.
#pragma once

#include <vector>

#include "cli/render/surface.h"

namespace selvage::cli {

class DepthMap {
 public:
  /// Seen from far along `direction` (unit, towards the light), orthographic, `size` texels square around `region`.
  /// Shadows are smoothed over `blur` texels to each side.
  DepthMap(const RenderSurface& surface, const Vec3& direction, const Bounds& region, int size, int blur);

  /// The part of the light that reaches the point, in [0, 1]; 1 outside the region.
  /// `normal` is that of the surface there: the point is lifted along it so that a surface does not shade itself.
  [[nodiscard]] double light_at(const Vec3& point, const Vec3& normal) const;

 private:
  [[nodiscard]] Vec3 to_texels(const Vec3& point) const;  ///< column, row, depth towards the light in length units

  Eigen::Matrix3d axes_;
  Vec3 center_;
  int size_, blur_;
  double texel_;  ///< length units
  std::vector<float> depth_;
};

}  // namespace selvage::cli
