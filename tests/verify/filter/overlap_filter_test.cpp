// The error bounds of the overlap filter: what meets is never called apart, however the rounding goes.
#include "verify/filter/overlap_filter.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "verify/arithmetic/fp_guard.h"
#include "verify/arithmetic/gaps.h"

namespace selvage::verify {
namespace {

double largest(const std::array<Point, 2>& points) {
  double size = 0;
  for (const Point& p : points) {
    for (const double x : p) size = std::max(size, std::abs(x));
  }
  return size;
}

/// A face from the origin and another that share, exactly, a ray from it: 1024 and 1025 times a vector of 40 bits. Else
/// they lie to both sides of it.
struct Cones {
  std::array<Point, 2> p, q;
};
Cones cones_with_a_common_ray(std::mt19937_64& random) {
  const auto whole = [&](int bits) {
    return static_cast<double>(static_cast<std::int64_t>(random() >> (63 - bits)) - (std::int64_t{1} << bits));
  };
  Cones cones;
  auto& [near, p] = cones.p;
  auto& [far, q] = cones.q;
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = whole(40);
    near[k] = 1024 * x;
    far[k] = 1025 * x;
    p[k] = whole(48);
  }
  const double along = dot(p, near) / dot(near, near);
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] -= along * near[k];
    q[k] = -p[k];
  }
  return cones;
}

/// Moves p along the ray until the direction between the middles of the cones is perpendicular to the ray, but for
/// rounding: which is then all that the products of that direction with the ray's points are.
void turn_across_the_ray(Cones& cones) {
  auto& [near, p] = cones.p;
  const auto& [far, q] = cones.q;
  const double p_size = largest(cones.p), q_size = largest(cones.q);
  Point between;
  for (std::size_t k = 0; k < 3; ++k) between[k] = q_size * (near[k] + p[k]) - p_size * (far[k] + q[k]);
  const double along = dot(between, near) / dot(near, near) / q_size;
  for (std::size_t k = 0; k < 3; ++k) p[k] -= along * near[k];
}

}  // namespace

// One in two thousand of them is where the bound is 32 times smaller.
TEST(OverlapFilter, ConesThatShareARayAreNeverCalledApart) {
  const FpGuard guard;
  std::mt19937_64 random(7);
  constexpr int kTurns = 3;
  int called_apart = 0;
  for (int round = 0; round < 100'000; ++round) {
    Cones cones = cones_with_a_common_ray(random);
    for (int turn = 0; turn < kTurns; ++turn) {
      called_apart += triage_apart_beyond_vertex({0, 0, 0}, cones.p, cones.q) ? 1 : 0;
      turn_across_the_ray(cones);
    }
  }
  EXPECT_EQ(called_apart, 0);
}

}  // namespace selvage::verify
