// Queries with a contact that is exact by construction: choose the time, the feature and integer weights, then back out
// the end points so that every step is exact in doubles.
#pragma once

#include <array>
#include <random>

#include "kernel/types.h"

namespace selvage::testing {

struct ConstructedContact {
  std::array<Vec3, 4> x_t0, x_t1;
  double contact_time;
};

class ContactGenerator {
 public:
  explicit ContactGenerator(std::uint64_t seed) : random_(seed) {}

  int integer(int first, int last) { return std::uniform_int_distribution<int>(first, last)(random_); }

  /// Integer points of magnitude <= 2^bits at `contact_time` in {0, 1/8, .., 1}; integer velocities; all exact.
  ConstructedContact vf(int bits) {
    // Corners are multiples of 4 and weights quarters, so the contact point is an integer.
    std::array<Vec3, 4> x;
    for (std::size_t i = 1; i < 4; ++i) x[i] = 4 * point(bits);
    const int wa = integer(0, 4), wb = integer(0, 4 - wa), wc = 4 - wa - wb;
    x[0] = (wa * x[1] + wb * x[2] + wc * x[3]) / 4;
    return move(x, bits);
  }

  ConstructedContact ee(int bits) {
    // Both edges pass through one integer point at quarters of their length.
    std::array<Vec3, 4> x;
    const Vec3 touch = point(bits);
    for (std::size_t edge = 0; edge < 4; edge += 2) {
      const int weight = integer(0, 4);
      const Vec3 along = point(bits);
      x[edge] = touch - weight * along;
      x[edge + 1] = touch + (4 - weight) * along;
    }
    return move(x, bits);
  }

  /// A vertex that meets the opposite edge of its own face; the fourth point takes no part.
  ConstructedContact self(int bits) {
    std::array<Vec3, 4> x = {Vec3::Zero(), 4 * point(bits), 4 * point(bits), Vec3::Zero()};
    const int weight = integer(0, 4);
    x[0] = (weight * x[1] + (4 - weight) * x[2]) / 4;
    return move(x, bits);
  }

 private:
  Vec3 point(int bits) {
    const int bound = (1 << bits) - 1;
    return {double(integer(-bound, bound)), double(integer(-bound, bound)), double(integer(-bound, bound))};
  }

  ConstructedContact move(const std::array<Vec3, 4>& x, int bits) {
    const double t = integer(0, 8) / 8.0;
    ConstructedContact result{x, x, t};
    for (std::size_t i = 0; i < 4; ++i) {
      const Vec3 velocity = 8 * point(bits);
      result.x_t0[i] = x[i] - t * velocity;
      result.x_t1[i] = x[i] + (1 - t) * velocity;
    }
    return result;
  }

  std::mt19937_64 random_;
};

/// Every point times a power of two, then shifted: exact when the caller leaves room in the significands.
template <std::size_t N>
std::array<Vec3, N> placed(const std::array<Vec3, N>& x, double scale, const Vec3& offset) {
  std::array<Vec3, N> result;
  for (std::size_t i = 0; i < N; ++i) result[i] = scale * x[i] + offset;
  return result;
}

}  // namespace selvage::testing
