#include "cli/render/depth_map.h"

#include <algorithm>
#include <limits>

#include <Eigen/Geometry>

#include "cli/render/triangle_raster.h"

namespace selvage::cli {

DepthMap::DepthMap(const RenderSurface& surface, const Vec3& direction, const Bounds& region, int size, int blur)
    : center_(region.center()),
      size_(size),
      blur_(blur),
      texel_(2 * std::max(region.radius(), std::numeric_limits<double>::min()) / size),
      depth_(static_cast<std::size_t>(size) * static_cast<std::size_t>(size), -std::numeric_limits<float>::infinity()) {
  const Vec3 right = direction.unitOrthogonal();
  axes_.row(0) = right;
  axes_.row(1) = direction.cross(right);
  axes_.row(2) = direction;
  std::vector<Vec3> seen;
  for (const Vec3& point : surface.points) seen.push_back(to_texels(point));
  for (const auto& t : surface.triangles) {
    const Vec3 &a = seen[static_cast<std::size_t>(t[0])], &b = seen[static_cast<std::size_t>(t[1])],
               &c = seen[static_cast<std::size_t>(t[2])];
    for_each_covered(
        {a.head<2>(), b.head<2>(), c.head<2>()}, size_, Rows{0, size_},
        [&](int x, int y, const Eigen::Vector3d& weight) {
          float& depth =
              depth_[static_cast<std::size_t>(y) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(x)];
          depth = std::max(depth, static_cast<float>(weight.dot(Vec3(a.z(), b.z(), c.z()))));
        });
  }
}

Vec3 DepthMap::to_texels(const Vec3& point) const {
  Vec3 seen = axes_ * (point - center_);
  seen.head<2>() = (seen.head<2>() / texel_).array() + size_ / 2.0;
  return seen;
}

double DepthMap::light_at(const Vec3& point, const Vec3& normal) const {
  // Texels of a plane that the light meets at up to 45 degrees differ by a texel's side in depth; half a texel is the
  // distance of a point from the middle of its own.
  const double reach = blur_ + 0.5;
  const Vec3 seen = to_texels(point + (reach + 0.5) * texel_ * normal);
  const double depth = seen.z() + reach * texel_;
  const int column = static_cast<int>(std::floor(std::clamp(seen.x(), -1.0 - blur_, size_ + blur_ + 1.0)));
  const int row = static_cast<int>(std::floor(std::clamp(seen.y(), -1.0 - blur_, size_ + blur_ + 1.0)));
  int lit = 0;
  for (int y = row - blur_; y <= row + blur_; ++y) {
    for (int x = column - blur_; x <= column + blur_; ++x) {
      const bool inside = x >= 0 && y >= 0 && x < size_ && y < size_;
      lit +=
          !inside ||
          double(depth_[static_cast<std::size_t>(y) * static_cast<std::size_t>(size_) + static_cast<std::size_t>(x)]) <=
              depth;
    }
  }
  return double(lit) / ((2 * blur_ + 1) * (2 * blur_ + 1));
}

}  // namespace selvage::cli
