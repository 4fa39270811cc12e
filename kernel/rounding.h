// Every error bound of the kernel, with its derivation. Proofs of the straight-line pieces: kernel/proofs/*.gappa;
// the arguments that join them: docs/guarantee.md; exact rationals against each bound: tests/kernel/rounding_test.cpp.
//
// Model (IEEE 754 binary64, to nearest, gradual underflow; FpEnvGuard establishes it):
//   fl(a + b) = (a + b)(1 + d), |d| <= u: sums have no underflow error;
//   fl(a * b) = (a * b)(1 + d) + h, |d| <= u, |h| <= 2^-1075.
// A product of n factors (1 + d) differs from 1 by at most n u / (1 - n u) (Higham 2002, Lemma 3.1). Each constant
// below carries at least u / 4 of slack for that denominator and for the roundings of the bound's own evaluation, both
// of second order.
//
// Scaled differences: with P - Q the exact difference of two stored points along one axis,
//   s = fl(P - Q) * 2^-k,  |s| < 1 for every corner difference, the largest in [0.5, 1).
// The subtraction costs u |s|; scaling is exact, or loses at most 2^-1074 where the result is subnormal.
// E (the extent, one value an axis) is at least every |s| on that axis at both ends of the step, and at least
// kExtentFloor, so that u E covers every underflow: the bounds need no further absolute term.
#pragma once

namespace selvage::detail {

inline constexpr double kUnitRoundoff = 0x1p-53;

/// Underflow of a product costs <= 2^-1075 and at most 64 of them enter one bound, each multiplied by a direction of
/// components <= 1 whose largest is >= 0.5: 64 * 2^-1074 < u * kExtentFloor * 0.5 / 4 = 2^-956.
inline constexpr double kExtentFloor = 0x1p-900;

/// x(t) = fl( fl((1-t) s0) + fl(t s1) ), with 1 - t exact (t is a multiple of 2^-52): the subtraction that made s,
/// the product and the sum: |x - X| <= 3 u ((1-t)|s0| + t|s1|) <= 3 u E.
inline constexpr double kPointRoundings = 3;

/// fl(n . x) with |n_j| <= 1: each product 1, first sum 1, second sum 1: 3 u sum |n_j| |x_j|, plus the points' own 3 u
/// E_j. 6 u (1 + O(u)), and the bound's own evaluation (3 roundings) is of second order.
inline constexpr double kSupportError = (kPointRoundings + 3.25) * kUnitRoundoff;

/// The witness sum w_i x_i, along one axis: the subtraction 1, product of two weights 1, product 1, two sums 2, of
/// sum w_i |x_i|. Corners interpolated to t lose kBlendError E besides, since they may cancel below their error.
inline constexpr double kWitnessError = 5.25 * kUnitRoundoff;
inline constexpr double kBlendError = (kPointRoundings + 0.25) * kUnitRoundoff;

/// sqrt(x^2 + y^2 + z^2), scaled so that nothing over- or underflows: squares 1, sums 2, halved by the root: 1.5 u;
/// the root 1 u; squares lost to underflow < 2^-1000 of the largest.
inline constexpr double kNormError = 2.75 * kUnitRoundoff;

/// A Bernstein coefficient of det[u(t), v(t), r(t)], relative to the permanent of the extents (each term a_i b_j c_k):
///   the three subtractions 3; the two products 2; the difference inside a cross product 1; the sum of the two cross
///   products in the doubled middle coefficient 1; the sums of the dot product 2; the sum of the two determinants 1;
///   the division by three 1: 11 u of (terms of three determinants) / 3, that is 11 u of one permanent.
inline constexpr double kDeterminantError = 11.5 * kUnitRoundoff;

/// Three levels of s a + t b with s + t = 1 exactly: each 2 u of the largest coefficient, error of the level before
/// carried on as a convex combination; underflow is covered by the absolute term of the cubic's own bound.
inline constexpr double kBlossomError = 6.25 * kUnitRoundoff;

}  // namespace selvage::detail
