#include "verify/arithmetic/predicates.h"

#include <algorithm>
#include <cmath>

#include "verify/arithmetic/dyadic.h"
#include "verify/arithmetic/gaps.h"

namespace selvage::verify {
namespace {

// Bounds on |computed - real| (u = 2^-53, gamma(n) = n u / (1 - n u); Higham 2002, Lemma 3.1):
// (1) A difference of coordinates is rounded once; where it is subnormal it is exact.
// (2) normal: p q - r s of differences: 2 differences, 1 product, 1 subtraction deep: gamma(4) (|p q| + |r s|).
//     orient3d: three such times a third difference, summed: 4 + 1 + 1 + 2 deep: gamma(8) of the sum of the magnitudes.
// (3) The magnitudes are computed with as many roundings: real <= computed / (1 - gamma(8)). 2^-49 = 16 u covers both.
// (4) A product that underflows loses at most 2^-1075. normal: two of them. orient3d: two per minor, each then times a
//     third difference <= m, and three outer products: 6 m 2^-1075 + 3 * 2^-1075; the same again in the magnitudes.
//     2^-1070 (m + 1) covers all of it, the rounding of m + 1 and of the bound itself included.
// Overflow gives infinity or NaN in value or bound, and then no comparison below succeeds.
constexpr double kRoundingFactor = 0x1p-49;
constexpr double kUnderflowLoss = 0x1p-1070;

int sign_beyond(double value, double bound) {
  if (value > bound) return 1;
  if (value < -bound) return -1;
  return 0;
}

}  // namespace

int triage_orient3d(const Point& a, const Point& b, const Point& c, const Point& d) {
  const Point p = difference(b, a), q = difference(c, a), r = difference(d, a);
  double value = 0, magnitude = 0, largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const double plus = p[i] * q[j], minus = p[j] * q[i];
    value += (plus - minus) * r[k];
    magnitude += (std::abs(plus) + std::abs(minus)) * std::abs(r[k]);
    largest = std::max(largest, std::abs(r[k]));
  }
  return sign_beyond(value, kRoundingFactor * magnitude + kUnderflowLoss * (largest + 1));
}

int triage_normal(int axis, const Point& a, const Point& b, const Point& c) {
  const auto i = static_cast<std::size_t>((axis + 1) % 3), j = static_cast<std::size_t>((axis + 2) % 3);
  const double plus = (b[i] - a[i]) * (c[j] - a[j]), minus = (b[j] - a[j]) * (c[i] - a[i]);
  return sign_beyond(plus - minus, kRoundingFactor * (std::abs(plus) + std::abs(minus)) + kUnderflowLoss);
}

const Predicates::IntegerPoint& Predicates::integer(int a) {
  if (!integers_) {
    integers_ = std::make_unique<std::array<IntegerPoint, 6>>();
    std::array<double, 18> values{};
    std::array<mpz_class, 18> scaled;
    for (std::size_t i = 0; i < points_.size(); ++i) std::copy(points_[i].begin(), points_[i].end(), &values[3 * i]);
    scale_to_integers(values, scaled);
    for (std::size_t i = 0; i < scaled.size(); ++i) (*integers_)[i / 3][i % 3] = std::move(scaled[i]);
  }
  return (*integers_)[static_cast<std::size_t>(a)];
}

int Predicates::orient3d(int a, int b, int c, int d) {
  if (a == b || a == c || a == d || b == c || b == d || c == d) return 0;
  const auto at = [&](int i) -> const Point& { return points_[static_cast<std::size_t>(i)]; };
  if (const int sign = triage_orient3d(at(a), at(b), at(c), at(d)); sign != 0) return sign;
  const IntegerPoint &o = integer(a), &p = integer(b), &q = integer(c), &r = integer(d);
  mpz_class determinant = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const mpz_class minor = (p[i] - o[i]) * (q[j] - o[j]) - (p[j] - o[j]) * (q[i] - o[i]);
    determinant += minor * (r[k] - o[k]);
  }
  return sgn(determinant);
}

int Predicates::normal(int axis, int a, int b, int c) {
  if (a == b || a == c || b == c) return 0;
  const auto at = [&](int i) -> const Point& { return points_[static_cast<std::size_t>(i)]; };
  if (const int sign = triage_normal(axis, at(a), at(b), at(c)); sign != 0) return sign;
  const IntegerPoint &o = integer(a), &p = integer(b), &q = integer(c);
  const auto i = static_cast<std::size_t>((axis + 1) % 3), j = static_cast<std::size_t>((axis + 2) % 3);
  const mpz_class component = (p[i] - o[i]) * (q[j] - o[j]) - (p[j] - o[j]) * (q[i] - o[i]);
  return sgn(component);
}

int Predicates::compare(int axis, int a, int b) const {
  const double x = points_[static_cast<std::size_t>(a)][static_cast<std::size_t>(axis)];
  const double y = points_[static_cast<std::size_t>(b)][static_cast<std::size_t>(axis)];
  return static_cast<int>(x > y) - static_cast<int>(x < y);
}

bool Predicates::equal(int a, int b) const {
  return a == b || points_[static_cast<std::size_t>(a)] == points_[static_cast<std::size_t>(b)];
}

int Predicates::projection_axis(int a, int b, int c) {
  // The filter on all axes first: one clear component saves integers for the zero ones.
  const auto at = [&](int i) -> const Point& { return points_[static_cast<std::size_t>(i)]; };
  for (int axis = 0; axis < 3; ++axis) {
    if (triage_normal(axis, at(a), at(b), at(c)) != 0) return axis;
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (normal(axis, a, b, c) != 0) return axis;
  }
  return -1;
}

}  // namespace selvage::verify
