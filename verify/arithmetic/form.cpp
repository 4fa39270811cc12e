#include "verify/arithmetic/form.h"

#include <utility>

namespace selvage::verify {

bool Form::is_zero() const {
  for (std::size_t i = 0; i <= degree; ++i) {
    if (c[i] != 0) return false;
  }
  return true;
}

bool Form::is_definite() const {
  const int sign = sgn(c[0]);
  for (std::size_t i = 1; i <= degree; ++i) {
    if (sgn(c[i]) != sign) return false;
  }
  return sign != 0;
}

Form operator-(const Form& a, const Form& b) {
  Form difference{a.degree, {}};
  for (std::size_t i = 0; i <= a.degree; ++i) difference.c[i] = a.c[i] - b.c[i];
  return difference;
}

FormVector operator-(const FormVector& a, const FormVector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

namespace {

/// sum += sign * a * b, for a sign of 1 or -1.
void add_product(Form& sum, const Form& a, const Form& b, int sign) {
  const auto accumulate = sign > 0 ? mpz_addmul : mpz_submul;
  for (std::size_t i = 0; i <= a.degree; ++i) {
    for (std::size_t j = 0; j <= b.degree; ++j) {
      accumulate(sum.c[i + j].get_mpz_t(), a.c[i].get_mpz_t(), b.c[j].get_mpz_t());
    }
  }
}

}  // namespace

Form cross_component(const FormVector& a, const FormVector& b, std::size_t k) {
  const std::size_t y = (k + 1) % 3, z = (k + 2) % 3;
  Form component{a[y].degree + b[z].degree, {}};
  add_product(component, a[y], b[z], 1);
  add_product(component, a[z], b[y], -1);
  return component;
}

FormVector cross(const FormVector& a, const FormVector& b) {
  return {cross_component(a, b, 0), cross_component(a, b, 1), cross_component(a, b, 2)};
}

Form dot(const FormVector& a, const FormVector& b) {
  Form sum{a[0].degree + b[0].degree, {}};
  for (std::size_t k = 0; k < 3; ++k) add_product(sum, a[k], b[k], 1);
  return sum;
}

int sign_changes(const Form& form) {
  int changes = 0, last = 0;
  for (std::size_t i = 0; i <= form.degree; ++i) {
    const int sign = sgn(form.c[i]);
    if (sign * last < 0) ++changes;
    if (sign != 0) last = sign;
  }
  return changes;
}

int sign_after_start(const Form& form) {
  for (std::size_t i = 0; i <= form.degree; ++i) {
    if (form.c[i] != 0) return sgn(form.c[i]);
  }
  return 0;
}

int sign_at(const Form& form, const mpz_class& numerator, unsigned long log2_denominator) {
  // Horner in t/s, made whole: value = sum c[i] s^(d-i) t^i, s = 2^m - t.
  const mpz_class& t = numerator;
  const mpz_class s = (mpz_class(1) << log2_denominator) - t;
  mpz_class value = form.c[form.degree], s_power = 1;
  for (std::size_t i = form.degree; i-- > 0;) {
    s_power *= s;
    value = value * t + form.c[i] * s_power;
  }
  return sgn(value);
}

// On [0, 1/2]: t = t'/2 and s = s' + t'/2; doubled, s = 2s' + t': first s -> s + t by additions, then s -> 2s by
// shifts.
Form left_half(Form form) {
  auto& c = form.c;
  for (std::size_t last = form.degree; last > 0; --last) {
    for (std::size_t i = 1; i <= last; ++i) c[i] += c[i - 1];
  }
  for (std::size_t i = 0; i < form.degree; ++i) c[i] <<= form.degree - i;
  return form;
}

// The mirror image.
Form right_half(Form form) {
  auto& c = form.c;
  for (std::size_t first = 0; first < form.degree; ++first) {
    for (std::size_t i = form.degree; i-- > first;) c[i] += c[i + 1];
  }
  for (std::size_t i = 1; i <= form.degree; ++i) c[i] <<= i;
  return form;
}

Form restrict_to(Form form, const mpz_class& numerator, unsigned long log2_denominator) {
  for (unsigned long bit = log2_denominator; bit-- > 0;) {
    const bool is_right = mpz_tstbit(numerator.get_mpz_t(), bit) != 0;
    form = is_right ? right_half(std::move(form)) : left_half(std::move(form));
  }
  return form;
}

namespace {

/// Factors s and t, whose roots are the ends 0 and 1, taken out: first and last coefficients are not zero.
Form without_end_roots(const Form& form) {
  std::size_t first = 0, last = form.degree;
  while (form.c[first] == 0) ++first;
  while (form.c[last] == 0) --last;
  Form rest{last - first, {}};
  for (std::size_t i = first; i <= last; ++i) rest.c[i - first] = form.c[i];
  return rest;
}

/// Divided by the greatest common divisor of the coefficients, which keeps the numbers of a remainder sequence small.
void make_primitive(Form& form) {
  mpz_class content = form.c[0];
  for (std::size_t i = 1; i <= form.degree; ++i) content = gcd(content, form.c[i]);
  for (std::size_t i = 0; i <= form.degree; ++i) {
    mpz_divexact(form.c[i].get_mpz_t(), form.c[i].get_mpz_t(), content.get_mpz_t());
  }
}

/// Polynomial division of a by b in x = t/s: a times a constant is quotient * b + remainder.
/// REQUIRES a.degree >= b.degree, leading coefficients not zero.
struct Division {
  Form quotient, remainder;
};
Division divide(const Form& a, const Form& b) {
  Division result{Form{a.degree - b.degree, {}}, a};
  auto& [quotient, remainder] = result;
  const mpz_class& lead = b.c[b.degree];
  for (std::size_t k = a.degree - b.degree + 1; k-- > 0;) {
    const mpz_class factor = remainder.c[k + b.degree];
    for (auto& c : quotient.c) c *= lead;
    for (auto& c : remainder.c) c *= lead;
    quotient.c[k] += factor;
    for (std::size_t i = 0; i <= b.degree; ++i) remainder.c[k + i] -= factor * b.c[i];
  }
  return result;
}

}  // namespace

Form common_divisor(const Form& a, const Form& b) {
  if (a.is_zero()) return without_end_roots(b);
  if (b.is_zero()) return without_end_roots(a);
  // Euclid. Roots at the ends do not count, so they are dropped wherever they show.
  Form high = without_end_roots(a), low = without_end_roots(b);
  while (true) {
    if (high.degree < low.degree) std::swap(high, low);
    const Form remainder = divide(high, low).remainder;
    if (remainder.is_zero()) return low;
    high = std::move(low);
    low = without_end_roots(remainder);
    make_primitive(low);
  }
}

Form square_free_part(const Form& form) {
  Form rest = without_end_roots(form);
  make_primitive(rest);
  if (rest.degree < 2) return rest;
  Form derivative{rest.degree - 1, {}};  // in x = t/s
  for (std::size_t i = 1; i <= rest.degree; ++i) derivative.c[i - 1] = rest.c[i] * static_cast<unsigned long>(i);
  const Form repeated = common_divisor(rest, derivative);
  if (repeated.degree == 0) return rest;
  Form once = divide(rest, repeated).quotient;
  make_primitive(once);
  return once;
}

}  // namespace selvage::verify
