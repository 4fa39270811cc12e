// The error bounds of the motion filter against exact rationals: never exceeded, and approached by a climb towards the
// worst rounding. A bound that is never approached is as suspect as a wrong one.
#include <random>

#include <gmpxx.h>
#include <gtest/gtest.h>

#include "verify/arithmetic/fp_guard.h"
#include "verify/filter/motion_piece.h"

namespace selvage::verify {
namespace {

constexpr std::size_t kCorners = 3;
using Number = mpq_class;
using ExactCorners = std::array<std::array<Number, kCorners>, 3>;

struct ExactPiece {
  ExactCorners start, end;
};

/// The point p and corners a, b, c at both ends of the step, and which half of the step is taken, again and again.
struct Sample {
  std::array<std::array<std::array<double, 3>, 4>, 2> x;
  unsigned path = 0;
  int depth = 0;
};

struct Shares {
  double cross = 0, cubic = 0;  ///< largest error, of the bound
};

Number determinant(const Number& a, const Number& b, const Number& c, const Number& d) { return a * d - b * c; }

Shares shares_of(const Sample& sample) {
  Piece<kCorners> piece;
  ExactPiece exact;
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < kCorners; ++j) {
      const auto &x0 = sample.x[0], &x1 = sample.x[1];
      piece.start[k][j] = x0[0][k] - x0[j + 1][k];
      piece.end[k][j] = x1[0][k] - x1[j + 1][k];
      exact.start[k][j] = Number(x0[0][k]) - Number(x0[j + 1][k]);
      exact.end[k][j] = Number(x1[0][k]) - Number(x1[j + 1][k]);
    }
  }
  const ErrorBounds bounds(piece);
  for (int i = 0; i < sample.depth; ++i) {
    const bool first_half = (sample.path >> i & 1U) == 0;
    const auto cut = middle(piece);
    (first_half ? piece.end : piece.start) = cut;
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t j = 0; j < kCorners; ++j) {
        const Number half = (exact.start[k][j] + exact.end[k][j]) / 2;
        (first_half ? exact.end : exact.start)[k][j] = half;
      }
    }
  }
  Shares shares;
  const auto share = [](double computed, const Number& real, double bound) {
    return Number(abs(Number(computed) - real) / Number(bound)).get_d();
  };
  std::array<Quadratic, 3> c1;
  std::array<std::array<Number, 3>, 3> exact_c1;
  for (std::size_t k = 0; k < 3; ++k) {
    c1[k] = cross(piece, 1, k);
    const std::size_t y = (k + 1) % 3, z = (k + 2) % 3;
    const auto at = [&](const ExactCorners& left, const ExactCorners& right) {
      return determinant(left[y][1], left[z][1], right[y][2], right[z][2]);
    };
    exact_c1[k] = {at(exact.start, exact.start), (at(exact.start, exact.end) + at(exact.end, exact.start)) / 2,
                   at(exact.end, exact.end)};
    for (std::size_t i = 0; i < 3; ++i) {
      shares.cross = std::max(shares.cross, share(c1[k][i], exact_c1[k][i], bounds.cross[k]));
    }
  }
  const std::array<double, 4> f = scaled_cubic(piece, c1);
  std::array<Number, 4> exact_f;
  for (std::size_t k = 0; k < 3; ++k) {
    const Number &start = exact.start[k][0], &end = exact.end[k][0];
    exact_f[0] += start * exact_c1[k][0];
    exact_f[1] += end * exact_c1[k][0] + 2 * start * exact_c1[k][1];
    exact_f[2] += start * exact_c1[k][2] + 2 * end * exact_c1[k][1];
    exact_f[3] += end * exact_c1[k][2];
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const double bound = (i == 0 || i == 3 ? 1 : 3) * bounds.cubic;
    shares.cubic = std::max(shares.cubic, share(f[i], exact_f[i], bound));
  }
  return shares;
}

/// The largest share that climbs from random samples reach; `of` picks the bound.
template <class Of>
double worst_share(const Of& of) {
  std::mt19937_64 random(5);
  const auto coordinate = [&] {
    const double x = static_cast<double>(random() >> 11) * 0x1p-52 - 1;
    return std::copysign(0.5 + 0.5 * std::abs(x), x);  // magnitudes alike: then the terms of the bounds are alike too
  };
  double worst = 0;
  for (int start = 0; start < 24; ++start) {
    Sample sample;
    sample.depth = start % (kMaxDepth + 1);
    sample.path = static_cast<unsigned>(random() % 128);
    for (auto& end : sample.x) {
      for (auto& point : end) {
        for (double& x : point) x = coordinate();
      }
    }
    double best = of(shares_of(sample));
    for (int step = 0; step < 250; ++step) {
      Sample changed = sample;
      changed.x[random() % 2][random() % 4][random() % 3] = coordinate();
      const double share = of(shares_of(changed));
      if (share > best) {
        best = share;
        sample = changed;
      }
    }
    worst = std::max(worst, best);
  }
  return worst;
}

TEST(MotionBounds, OfTheCrossProductsIsApproachedAndNeverExceeded) {
  const FpGuard guard;
  const double worst = worst_share([](const Shares& shares) { return shares.cross; });
  RecordProperty("used_percent", static_cast<int>(100 * worst));
  EXPECT_LT(worst, 1);
  EXPECT_GT(worst, 0.05);
}

TEST(MotionBounds, OfTheCubicIsApproachedAndNeverExceeded) {
  const FpGuard guard;
  const double worst = worst_share([](const Shares& shares) { return shares.cubic; });
  RecordProperty("used_percent", static_cast<int>(100 * worst));
  EXPECT_LT(worst, 1);
  EXPECT_GT(worst,
            0.02);  // some forty roundings seldom all go one way: a bound 64 times smaller is exceeded all the same
}

}  // namespace
}  // namespace selvage::verify
