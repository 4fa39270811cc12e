#include "verify/decision/explain.h"

#include <utility>

#include "verify/arithmetic/fp_guard.h"
#include "verify/decision/contact.h"

namespace selvage::verify {
namespace {

/// moving_points() multiplies all coordinates by 2^k: this k.
template <std::size_t N>
int log2_scale(const std::array<Point, N>& x_t0, const std::array<Point, N>& x_t1) {
  std::array<double, 6 * N> values{};
  std::array<mpz_class, 6 * N> integers;
  for (std::size_t i = 0; i < 3 * N; ++i) {
    values[2 * i] = x_t0[i / 3][i % 3];
    values[2 * i + 1] = x_t1[i / 3][i % 3];
  }
  return scale_to_integers(values, integers);
}

ExplainedPolynomial explained(std::string name, const Form& form, int scale) {
  constexpr std::array<std::array<long, 4>, 4> kBinomials = {{{1, 0, 0, 0}, {1, 1, 0, 0}, {1, 2, 1, 0}, {1, 3, 3, 1}}};
  ExplainedPolynomial result;
  result.name = std::move(name);
  result.is_zero = form.is_zero();
  result.sign_t0 = sgn(form.c[0]);
  result.sign_t1 = sgn(form.c[form.degree]);
  const int log2_units = scale * static_cast<int>(form.degree);  // a product of as many lengths as its degree
  for (std::size_t i = 0; i <= form.degree; ++i) {
    mpq_class value(form.c[i], kBinomials[form.degree][i]);
    value.canonicalize();
    if (log2_units >= 0) {
      value /= mpz_class(1) << static_cast<unsigned long>(log2_units);
    } else {
      value *= mpz_class(1) << static_cast<unsigned long>(-log2_units);
    }
    result.bernstein.push_back(value.get_str());
    result.approx.push_back(value.get_d());
  }
  if (result.is_zero) return result;
  for (Instant& root : roots_inside(form)) result.roots.push_back(exact_time(std::move(root)));
  return result;
}

}  // namespace

ExplainedPolynomial explain_vf_motion(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1) {
  const FpGuard guard;
  const auto x = moving_points(x_t0, x_t1);
  return explained("coplanarity", dot(cross(x[2] - x[1], x[3] - x[1]), x[0] - x[1]), log2_scale(x_t0, x_t1));
}

ExplainedPolynomial explain_ee_motion(const std::array<Point, 4>& x_t0, const std::array<Point, 4>& x_t1) {
  const FpGuard guard;
  const auto x = moving_points(x_t0, x_t1);
  return explained("coplanarity", dot(cross(x[1] - x[0], x[3] - x[2]), x[2] - x[0]), log2_scale(x_t0, x_t1));
}

std::vector<ExplainedPolynomial> explain_self_motion(const std::array<Point, 3>& x_t0,
                                                     const std::array<Point, 3>& x_t1) {
  const FpGuard guard;
  const auto x = moving_points(x_t0, x_t1);
  const FormVector area = cross(x[1] - x[0], x[2] - x[0]);
  std::vector<ExplainedPolynomial> result;
  for (std::size_t k = 0; k < 3; ++k) {
    result.push_back(explained(std::string("area ") + "xyz"[k], area[k], log2_scale(x_t0, x_t1)));
  }
  return result;
}

}  // namespace selvage::verify
