// An algebraic time in [0,1] and the signs of forms at it.
#pragma once

#include <vector>

#include "verify/arithmetic/exact_time.h"
#include "verify/arithmetic/form.h"

namespace selvage::verify {

/// Either the dyadic rational numerator / 2^log2_denominator, or the only root, a simple one, of a form in the open
/// interval from there to (numerator + 1) / 2^log2_denominator. Refining narrows the interval, not the number.
class Instant {
 public:
  [[nodiscard]] static Instant dyadic(mpz_class numerator, unsigned long log2_denominator);
  [[nodiscard]] static Instant start() { return dyadic(0, 0); }
  [[nodiscard]] static Instant end() { return dyadic(1, 0); }

  [[nodiscard]] bool is_dyadic() const { return is_dyadic_; }
  [[nodiscard]] const mpz_class& numerator() const { return numerator_; }
  [[nodiscard]] unsigned long log2_denominator() const { return log2_denominator_; }

  /// The sign of the form at this instant; exact. Refines the interval as far as it needs.
  [[nodiscard]] int sign_of(const Form& form);
  /// The form has a root of odd multiplicity here, so it changes sign. REQUIRES that the form is not zero and that the
  /// interval holds no other root of it.
  [[nodiscard]] bool is_odd_root_of(const Form& form) const;
  /// Halves the interval, or finds that the root is its midpoint. REQUIRES not dyadic.
  void refine();

  friend std::vector<Instant> roots_inside(const Form& form);
  friend int compare(Instant& a, Instant& b);

 private:
  /// To one half of the interval; the root need not be there.
  void descend(bool is_right);

  Form defining_;  ///< on [0,1]; unless dyadic
  Form local_;     ///< the same on the interval, which has one sign change
  mpz_class numerator_;
  unsigned long log2_denominator_ = 0;
  bool is_dyadic_ = true;
};

/// The roots of the form in (0,1), in ascending order, each once, in disjoint intervals. REQUIRES not zero.
[[nodiscard]] std::vector<Instant> roots_inside(const Form& form);

/// As the rest of the program sees it: refined to a width of at most 2^-60.
[[nodiscard]] ExactTime exact_time(Instant instant);

/// -1, 0, 1: a earlier than b, the same time, later; exact. Refines both as far as it needs.
[[nodiscard]] int compare(Instant& a, Instant& b);

}  // namespace selvage::verify
