// Which pixels a triangle covers, and with which weights.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Core>

namespace selvage::cli {

/// Rows [begin, end) of a picture.
struct Rows {
  int begin, end;
};

/// Calls visit(x, y, weights) for every pixel in `rows` of a picture that is `width` wide whose centre lies in the
/// triangle of the given screen positions (pixels, y downwards, either orientation). `weights` are the barycentric
/// coordinates on the screen. Triangles without area cover nothing.
template <class Visit>
void for_each_covered(const std::array<Eigen::Vector2d, 3>& corner, int width, Rows rows, Visit visit) {
  const auto cross = [](const Eigen::Vector2d& u, const Eigen::Vector2d& v) { return u.x() * v.y() - u.y() * v.x(); };
  const double area = cross(corner[1] - corner[0], corner[2] - corner[0]);
  if (!(std::abs(area) > 0)) return;
  const Eigen::Vector2d lower = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]);
  const Eigen::Vector2d upper = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]);
  if (!(upper.x() >= 0 && upper.y() >= rows.begin && lower.x() <= width && lower.y() <= rows.end)) return;
  const int x_begin = static_cast<int>(std::floor(std::max(0.0, lower.x())));
  const int y_begin = static_cast<int>(std::floor(std::max(double(rows.begin), lower.y())));
  const int x_end = static_cast<int>(std::ceil(std::min(double(width), upper.x())));
  const int y_end = static_cast<int>(std::ceil(std::min(double(rows.end), upper.y())));
  for (int y = y_begin; y < y_end; ++y) {
    for (int x = x_begin; x < x_end; ++x) {
      const Eigen::Vector2d p(x + 0.5, y + 0.5);
      const double w0 = cross(corner[1] - p, corner[2] - p) / area;
      const double w1 = cross(corner[2] - p, corner[0] - p) / area;
      const double w2 = cross(corner[0] - p, corner[1] - p) / area;
      if (w0 >= 0 && w1 >= 0 && w2 >= 0) visit(x, y, Eigen::Vector3d(w0, w1, w2));
    }
  }
}

}  // namespace selvage::cli
