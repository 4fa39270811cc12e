// The polynomials behind a decision about a motion, for people: what vanishes when, and with which signs.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "verify/decision/exact_motion.h"

namespace selvage::verify {

/// A polynomial in t on [0,1], exactly.
struct ExplainedPolynomial {
  std::string name;
  std::vector<std::string> bernstein;  ///< coefficients, rationals in lowest terms, in the units of the input
  std::vector<double> approx;          ///< the same, rounded towards zero; infinite where they leave the doubles
  bool is_zero = false;                ///< vanishes for all t
  int sign_t0 = 0, sign_t1 = 0;
  std::vector<ExactTime> roots;  ///< inside (0,1), ascending, each once
};

/// The coplanarity cubic of a vertex-face or edge-edge motion: six times the signed volume that the four points span.
[[nodiscard]] ExplainedPolynomial explain_vf_motion(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1);
[[nodiscard]] ExplainedPolynomial explain_ee_motion(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1);
/// A vertex and the opposite edge of its face: the three components of twice the face's area vector.
[[nodiscard]] std::vector<ExplainedPolynomial> explain_self_motion(const std::array<Point, 3>& x_t0,
                                                                   const std::array<Point, 3>& x_t1);

}  // namespace selvage::verify
