// Every error bound of the kernel, with its derivation. Proofs of the straight-line pieces: kernel/proofs/*.gappa;
// the arguments that join them: docs/guarantee-kernel.md; exact rationals against each bound:
// tests/kernel/rounding_test.cpp.
//
// Model (IEEE 754 binary64, to nearest, gradual underflow; FpEnvGuard establishes it), u = 2^-53:
//   fl(a + b) = (a + b)(1 + d), |d| <= u: sums have no underflow error;
//   fl(a * b) = (a * b)(1 + d) + h, |d| <= u, |h| <= 2^-1075.
// In double-double arithmetic a product costs 7 * 2^-106 and a sum 3 * 2^-106, relative (Joldes, Muller, Popescu 2017,
// theorems 5.1 and 3.1), with a small multiple of 2^-1074 for h, and the difference of two doubles nothing.
// A product of n factors (1 + d) differs from 1 by at most n u / (1 - n u) (Higham 2002, Lemma 3.1). Each constant
// below counts the differences of stored points, products and sums in a row, and adds a quarter of a product for that
// denominator and for the evaluation of the bound itself, both of second order in u.
//
// Scaled differences: with P - Q the exact difference of two stored points along one axis,
//   s = fl(P - Q) * 2^-k,  |s| < 1 for every corner difference, the largest in [0.5, 1).
// The subtraction costs u |s|; scaling is exact, or loses at most 2^-1074 where the result is subnormal.
// The extent E (one value an axis) is the largest |s| on that axis over all corners and both ends of the step.
#pragma once

#include <algorithm>

#include "kernel/arithmetic/double_double.h"

namespace selvage::detail {

inline constexpr double kUnitRoundoff = 0x1p-53;

/// What one operation costs, relative to its result.
template <class Real>
struct RoundingOf {
  static constexpr double kDifference = kUnitRoundoff, kProduct = kUnitRoundoff, kSum = kUnitRoundoff;
};
template <>
struct RoundingOf<DoubleDouble> {
  static constexpr double kDifference = 0, kProduct = 7 * 0x1p-106, kSum = 3 * 0x1p-106;
};

/// The bound for a value that so many differences of stored points, products and sums go into, one after another.
template <class Real>
constexpr double error_of(int differences, int products, int sums) {
  using Rounding = RoundingOf<Real>;
  return differences * Rounding::kDifference + (products + 0.25) * Rounding::kProduct + sums * Rounding::kSum;
}

/// What underflow costs a bound: every lost product is at most 2^-1074, times factors below 2^12, at most 2^8 of them;
/// value by value at most 2^-1058 (kernel/proofs/underflow.gappa).
inline constexpr double kUnderflowError = 0x1p-1000;

/// x(t) = fl( fl((1-t) s0) + fl(t s1) ), with t and 1 - t exact: the subtraction that made s, the product, the sum.
///   |x - X| <= 3 u ((1-t)|s0| + t|s1|) <= 3 u E.
/// Without a quarter, because rounding to nearest has |d| <= u / (1 + u) (support.gappa).
inline constexpr double kPointRoundings = 3;

/// fl(n . x): each product 1, the sums 2, relative to sum |n_j| |x_j|; and the points' own 3 u E_j:
///   |fl(n . x) - n . X| <= 6 u sum |n_j| E_j.
template <class Real>
inline constexpr double kSupportError = error_of<Real>(1, 2, 3);

/// The witness sum w_i x_i, along one axis: the subtraction 1, the product of two weights 1, the product 1, three sums
/// 3, relative to sum w_i |x_i|. Corners interpolated to t lose kBlendError E besides, since they may cancel.
inline constexpr double kWitnessError = error_of<double>(1, 2, 3);
inline constexpr double kBlendError = error_of<double>(1, 1, 1);

/// sqrt(x^2 + y^2 + z^2), scaled so that nothing that matters under- or overflows: squares 1 and sums 2, halved by the
/// root: 1.5; the root 1.
inline constexpr double kNormError = 2.75 * kUnitRoundoff;

/// The last factors of distances, relative: of a margin over a norm, with the factor itself, under 8 roundings; of the
/// witness's norm over the sum of its weights, which is good to 5 u, and a few more.
inline constexpr double kQuotientError = 8 * kUnitRoundoff;
inline constexpr double kWitnessQuotientError = 32 * kUnitRoundoff;

/// A Bernstein coefficient of 3 det[u(t), v(t), r(t)], relative to three permanents of the extents (terms a_i b_j c_k):
///   the three subtractions 3; the two products 2; the difference inside a cross product 1; the sum of the two cross
///   products in the doubled middle coefficient 1; the sums of the dot product 2; the sum of the two determinants 1.
///   The outer coefficients have a third product, with 3, in place of the two sums, so that 3 and 4 cover both.
template <class Real>
inline constexpr double kDeterminantError = error_of<Real>(3, 3, 4);

/// Three levels of s a + t b with s + t = 1 exactly: each 2 u of the largest coefficient; the error of the level before
/// is carried on as a convex combination.
template <class Real>
inline constexpr double kBlossomError = error_of<Real>(0, 3, 3);

/// A component d_i e_j - d_j e_i of the cross product of an interpolated corner and an interpolated edge: the points 3
/// + 3, the product 1, the difference 1, and 1 for the sum of two in a middle coefficient; relative to D_i E_j + D_j
/// E_i (the extents of corners and edges), twice for the doubled middle coefficient.
template <class Real>
inline constexpr double kWindingError = error_of<Real>(2, 3, 4);

/// The cull in lanes projects the points themselves, in float32 (u = 2^-24), in a scale in which every |coordinate| is
/// at most 1; N = |n_x| + |n_y| + |n_z|. A direction n separates the features over the step if, at both its ends,
/// n . p > n . q for all vertices p of the first and q of the second: then it does so for all points, at all times
/// between.
///   a coordinate: rounded to float32, 1; what its double was off by is below 2^-20 u;
///   a projection: the product 1, the sums 2, and the coordinates' 1: 4 u N;
///   two of them, and their difference, which is below 2 N: 10 u N.
/// The bound (kNearError + tolerance) N + kNearSlack is computed with 5 roundings, of second order; they, and the
/// doubles', are in the half. Euclidean: N >= |n|. Each of the 6 products may lose 2^-150: kNearSlack. Infinity and NaN
/// in n make N so, and then prove nothing.
inline constexpr float kNearUnitRoundoff = 0x1p-24F;
inline constexpr float kNearError = 10.5F * kNearUnitRoundoff;
inline constexpr float kNearSlack = 0x1p-140F;
/// A tolerance in that scale in float32, rounded up by more than the 8 roundings on its way. Nothing is 4 apart.
inline float near_tolerance(double tolerance) {
  return tolerance > 0 ? static_cast<float>(std::min(tolerance, 4.0) * (1 + 0x1p-20)) + 0x1p-126F : 0.0F;
}

}  // namespace selvage::detail
