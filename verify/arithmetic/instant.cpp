#include "verify/arithmetic/instant.h"

#include <utility>

#include "verify/arithmetic/dyadic.h"

namespace selvage::verify {
namespace {

int sign_at_middle(const Form& form) {
  mpz_class sum = form.c[0];
  for (std::size_t i = 1; i <= form.degree; ++i) sum += form.c[i];
  return sgn(sum);
}

}  // namespace

Instant Instant::dyadic(mpz_class numerator, unsigned long log2_denominator) {
  Instant instant;
  instant.numerator_ = std::move(numerator);
  instant.log2_denominator_ = log2_denominator;
  return instant;
}

void Instant::descend(bool is_right) {
  local_ = is_right ? right_half(std::move(local_)) : left_half(std::move(local_));
  numerator_ = numerator_ * 2 + (is_right ? 1 : 0);
  ++log2_denominator_;
}

void Instant::refine() {
  const int middle = sign_at_middle(local_);
  if (middle == 0) {
    *this = dyadic(numerator_ * 2 + 1, log2_denominator_ + 1);
  } else {
    descend(middle == sign_after_start(local_));
  }
}

int Instant::sign_of(const Form& form) {
  if (is_dyadic_) return sign_at(form, numerator_, log2_denominator_);
  if (form.is_definite()) return sgn(form.c[0]);
  Form on_interval = restrict_to(form, numerator_, log2_denominator_);
  if (sign_changes(on_interval) > 0) {
    const Form common = common_divisor(defining_, form);
    if (common.degree > 0 && is_odd_root_of(common)) return 0;
  }
  // Not zero here, so a small enough interval shows the sign.
  while (sign_changes(on_interval) > 0) {
    refine();
    if (is_dyadic_) return sign_at(form, numerator_, log2_denominator_);
    const bool is_right = mpz_odd_p(numerator_.get_mpz_t()) != 0;
    on_interval = is_right ? right_half(std::move(on_interval)) : left_half(std::move(on_interval));
  }
  return sign_after_start(on_interval);
}

bool Instant::is_odd_root_of(const Form& form) const {
  const Form on_interval = restrict_to(form, numerator_, log2_denominator_);
  if (!is_dyadic_) return sign_changes(on_interval) % 2 == 1;
  std::size_t multiplicity = 0;  // of the root at the interval's start
  while (on_interval.c[multiplicity] == 0) ++multiplicity;
  return multiplicity % 2 == 1;
}

std::vector<Instant> roots_inside(const Form& form) {
  std::vector<Instant> roots;
  const int changes_of_whole = sign_changes(form);
  if (changes_of_whole == 0) return roots;
  // Depth first, left before right. An interval with a single sign change has one root, a simple one. For a square-free
  // form small enough intervals have at most one change (Vincent's theorem), so this ends.
  Instant whole;
  whole.defining_ = changes_of_whole == 1 ? form : square_free_part(form);
  whole.local_ = whole.defining_;
  whole.is_dyadic_ = false;
  std::vector<Instant> pending{std::move(whole)};
  while (!pending.empty()) {
    Instant piece = std::move(pending.back());
    pending.pop_back();
    const int changes = piece.is_dyadic_ ? 1 : sign_changes(piece.local_);
    if (changes == 1) roots.push_back(std::move(piece));
    if (changes <= 1) continue;
    Instant right = piece;
    right.descend(true);
    pending.push_back(std::move(right));
    if (sign_at_middle(piece.local_) == 0) {
      pending.push_back(Instant::dyadic(piece.numerator_ * 2 + 1, piece.log2_denominator_ + 1));
    }
    piece.descend(false);
    pending.push_back(std::move(piece));
  }
  return roots;
}

ExactTime exact_time(Instant instant) {
  constexpr unsigned long kLog2MaxWidth = 60;  // ExactTime's width is at most 2^-60
  while (!instant.is_dyadic() && instant.log2_denominator() < kLog2MaxWidth) instant.refine();
  const unsigned long scale = instant.log2_denominator();
  const mpz_class& low = instant.numerator();
  const mpz_class high = instant.is_dyadic() ? low : low + 1;
  const auto text = [scale](const mpz_class& numerator) {
    mpq_class value(numerator, mpz_class(1) << scale);
    value.canonicalize();
    return value.get_str();
  };
  return {text(low), text(high), round_down(low, scale), round_up(high, scale)};
}

int compare(Instant& a, Instant& b) {
  bool may_be_equal = true;
  while (true) {
    // Both as intervals [low, high] over the finer denominator; dyadic instants have low == high.
    const bool a_is_finer = a.log2_denominator_ > b.log2_denominator_;
    const unsigned long scale = a_is_finer ? a.log2_denominator_ : b.log2_denominator_;
    const mpz_class a_low = a.numerator_ << (scale - a.log2_denominator_);
    const mpz_class b_low = b.numerator_ << (scale - b.log2_denominator_);
    const mpz_class a_high = a_low + (a.is_dyadic_ ? mpz_class(0) : mpz_class(1) << (scale - a.log2_denominator_));
    const mpz_class b_high = b_low + (b.is_dyadic_ ? mpz_class(0) : mpz_class(1) << (scale - b.log2_denominator_));
    if (a.is_dyadic_ && b.is_dyadic_) return cmp(a_low, b_low) < 0 ? -1 : (a_low == b_low ? 0 : 1);
    if (a_high <= b_low) return -1;  // intervals are open, so a common end parts them
    if (b_high <= a_low) return 1;
    if (a.is_dyadic_ || b.is_dyadic_) {
      // The dyadic one lies inside the open interval of the other: the sign there tells the side.
      const bool dyadic_is_a = a.is_dyadic_;
      const Instant& point = dyadic_is_a ? a : b;
      const Instant& root = dyadic_is_a ? b : a;
      const int sign = sign_at(root.defining_, point.numerator_, point.log2_denominator_);
      const int point_against_root = sign == 0 ? 0 : (sign == sign_after_start(root.local_) ? -1 : 1);
      return dyadic_is_a ? point_against_root : -point_against_root;
    }
    if (may_be_equal) {
      // Dyadic intervals that overlap are nested. A common root in the inner one is the root of both.
      const Instant& inner = a_is_finer ? a : b;
      const Form common = common_divisor(a.defining_, b.defining_);
      if (common.degree > 0 && inner.is_odd_root_of(common)) return 0;
      may_be_equal = false;
    }
    (a_is_finer ? b : a).refine();  // the wider one
  }
}

}  // namespace selvage::verify
