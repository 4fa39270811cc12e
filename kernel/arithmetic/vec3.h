// Vectors of certified code: every operation is written out, so that the order of roundings is part of the source (K7).
#pragma once

#include <algorithm>
#include <cmath>

#include "kernel/arithmetic/double_double.h"
#include "kernel/types.h"

namespace selvage::detail {

/// Real is double, or DoubleDouble where doubles could not decide.
template <class Real>
struct Triple {
  Real x{}, y{}, z{};
};
using Double3 = Triple<double>;

template <class Real>
Triple<Real> operator+(const Triple<Real>& a, const Triple<Real>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class Real>
Triple<Real> operator-(const Triple<Real>& a, const Triple<Real>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class Real>
Triple<Real> operator-(const Triple<Real>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class Real>
Triple<Real> scaled(const Real& s, const Triple<Real>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class Real>
Real dot(const Triple<Real>& a, const Triple<Real>& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
template <class Real>
Triple<Real> cross(const Triple<Real>& a, const Triple<Real>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

inline double leading(double a) { return a; }
inline double leading(const DoubleDouble& a) { return a.hi; }
/// The vector in double precision; nothing that is proved may depend on what this drops.
template <class Real>
Double3 leading(const Triple<Real>& a) {
  return {leading(a.x), leading(a.y), leading(a.z)};
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
