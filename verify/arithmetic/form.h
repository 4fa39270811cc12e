// Binary forms: homogeneous integer polynomials  sum_i c[i] s^(d-i) t^i  with s = 1 - t, of degree at most 3.
//
// They are Bernstein polynomials with the binomials multiplied in. On [0,1]: c[0] and c[d] are the values at the ends,
// a product is a convolution, and by Descartes' rule (in x = t/s, which runs through (0, infinity)) the number of roots
// in (0,1), counted with multiplicity, is at most the number of sign changes of c and has its parity.
#pragma once

#include <array>
#include <cstddef>

#include <gmpxx.h>

namespace selvage::verify {

struct Form {
  static constexpr std::size_t kMaxDegree = 3;

  std::size_t degree = 0;
  std::array<mpz_class, kMaxDegree + 1> c;  ///< those above the degree are zero

  [[nodiscard]] bool is_zero() const;
  [[nodiscard]] bool is_definite() const;  ///< all coefficients have the same sign, not zero
};

/// REQUIRES equal degrees.
[[nodiscard]] Form operator-(const Form& a, const Form& b);

/// A vector of three forms of one degree.
using FormVector = std::array<Form, 3>;
[[nodiscard]] FormVector operator-(const FormVector& a, const FormVector& b);
/// Products: REQUIRES degrees that add up to at most 3.
[[nodiscard]] FormVector cross(const FormVector& a, const FormVector& b);
/// One of its components.
[[nodiscard]] Form cross_component(const FormVector& a, const FormVector& b, std::size_t k);
[[nodiscard]] Form dot(const FormVector& a, const FormVector& b);

/// Sign changes of the coefficients, zeros left out.
[[nodiscard]] int sign_changes(const Form& form);
/// The sign just after t = 0: of the first non-zero coefficient.
[[nodiscard]] int sign_after_start(const Form& form);
/// The sign at t = numerator / 2^log2_denominator.
[[nodiscard]] int sign_at(const Form& form, const mpz_class& numerator, unsigned long log2_denominator);

/// The form on [0, 1/2] and on [1/2, 1], each as a form on [0,1], times a positive constant.
[[nodiscard]] Form left_half(Form form);
[[nodiscard]] Form right_half(Form form);
/// The form on [numerator, numerator + 1] / 2^log2_denominator as a form on [0,1], times a positive constant.
/// REQUIRES an interval inside [0,1]. Cost: a halving for every level.
[[nodiscard]] Form restrict_to(Form form, const mpz_class& numerator, unsigned long log2_denominator);

/// A form with exactly the common roots of a and b in (0,1), each as often as in both. REQUIRES not both zero.
[[nodiscard]] Form common_divisor(const Form& a, const Form& b);
/// A form with exactly the roots of `form` in (0,1), each once. REQUIRES not zero.
[[nodiscard]] Form square_free_part(const Form& form);

}  // namespace selvage::verify
