// The cross product as a matrix.
#pragma once

#include <Eigen/Core>

#include "kernel/types.h"

namespace selvage::sim {

/// Of v -> a x v.
[[nodiscard]] inline Eigen::Matrix3d cross_matrix(const Vec3& a) {
  Eigen::Matrix3d result;
  result << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return result;
}

}  // namespace selvage::sim
