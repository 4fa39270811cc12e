// Vectors of certified code: every operation is written out, so that the order of roundings is part of the source (K7).
#pragma once

#include <algorithm>
#include <cmath>

#include "kernel/types.h"

namespace selvage::detail {

struct Double3 {
  double x = 0, y = 0, z = 0;
};

inline Double3 operator+(const Double3& a, const Double3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Double3 operator-(const Double3& a, const Double3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Double3 operator-(const Double3& a) { return {-a.x, -a.y, -a.z}; }
inline Double3 operator*(double s, const Double3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline double dot(const Double3& a, const Double3& b) { return (a.x * b.x + a.y * b.y) + a.z * b.z; }
inline Double3 cross(const Double3& a, const Double3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Double3 abs(const Double3& a) { return {std::fabs(a.x), std::fabs(a.y), std::fabs(a.z)}; }
inline Double3 max(const Double3& a, const Double3& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}
inline double max_component(const Double3& a) { return std::max(std::max(a.x, a.y), a.z); }
inline bool is_zero(const Double3& a) { return a.x == 0 && a.y == 0 && a.z == 0; }
inline Double3 to_double3(const Vec3& v) { return {v[0], v[1], v[2]}; }
inline Vec3 to_vec3(const Double3& a) { return {a.x, a.y, a.z}; }

}  // namespace selvage::detail
