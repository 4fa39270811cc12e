// Exact rationals as the reference for the kernel's bounds.
#pragma once

#include <array>
#include <cmath>

#include <gmpxx.h>

#include "kernel/query/pair_motion.h"

namespace selvage::testing {

using Rational = mpq_class;
struct Rational3 {
  std::array<Rational, 3> axis;
  Rational& operator[](std::size_t i) { return axis[i]; }
  const Rational& operator[](std::size_t i) const { return axis[i]; }
};

inline Rational exact(double value) { return Rational(value); }
inline Rational exact(const detail::DoubleDouble& value) { return Rational(value.hi) + Rational(value.lo); }
template <class Real>
Rational3 exact(const detail::Triple<Real>& v) {
  return {{exact(v.x), exact(v.y), exact(v.z)}};
}

/// value * 2^e for any e.
inline Rational scaled_exactly(const Rational& value, int e) {
  Rational result = value;
  if (e >= 0) {
    mpq_mul_2exp(result.get_mpq_t(), value.get_mpq_t(), static_cast<mp_bitcnt_t>(e));
  } else {
    mpq_div_2exp(result.get_mpq_t(), value.get_mpq_t(), static_cast<mp_bitcnt_t>(-e));
  }
  return result;
}

inline Rational3 operator-(const Rational3& a, const Rational3& b) { return {{a[0] - b[0], a[1] - b[1], a[2] - b[2]}}; }
inline Rational3 operator+(const Rational3& a, const Rational3& b) { return {{a[0] + b[0], a[1] + b[1], a[2] + b[2]}}; }
inline Rational3 operator*(const Rational& s, const Rational3& a) { return {{s * a[0], s * a[1], s * a[2]}}; }
inline Rational dot(const Rational3& a, const Rational3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Rational3 cross(const Rational3& a, const Rational3& b) {
  return {{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]}};
}
inline Rational squared(const Rational& a) { return a * a; }

/// |error| / bound as a double, for records; the comparison itself is exact.
inline double ratio(const Rational& error, double bound) { return Rational(abs(error) / exact(bound)).get_d(); }

/// The corner differences of a pair, exactly: p - a, p - b, p - c | a - c, a - d, b - c, b - d | p - a, p - b.
inline std::array<Rational3, 4> exact_corners(PairKind kind, const std::array<Rational3, 4>& x) {
  switch (kind) {
    case PairKind::kVf:
      return {x[0] - x[1], x[0] - x[2], x[0] - x[3], x[0] - x[3]};
    case PairKind::kEe:
      return {x[0] - x[2], x[0] - x[3], x[1] - x[2], x[1] - x[3]};
    case PairKind::kSelf:
      break;
  }
  return {x[0] - x[1], x[0] - x[2], x[0] - x[2], x[0] - x[2]};
}

inline std::array<Rational3, 4> exact_points(const std::array<detail::Double3, 4>& x) {
  return {exact(x[0]), exact(x[1]), exact(x[2]), exact(x[3])};
}

/// Every point on its straight line at t.
inline std::array<Rational3, 4> exact_points(const std::array<detail::Double3, 4>& x_t0,
                                             const std::array<detail::Double3, 4>& x_t1, const Rational& t) {
  std::array<Rational3, 4> x;
  for (std::size_t i = 0; i < 4; ++i) x[i] = Rational(1 - t) * exact(x_t0[i]) + t * exact(x_t1[i]);
  return x;
}

}  // namespace selvage::testing
