#include <cmath>

#include "tests/kernel/random_points.h"
#include "tests/same_bits/hash.h"

namespace selvage::testing {

namespace {

using Points = std::array<Vec3, 4>;

constexpr int kQueryCount = 3000;

/// 0: generic; 1: lattice, all degenerate cases; 2, 3: lattice with noise of 2^-50 and 2^-10; 4: needles; 5: a touch at
/// a chosen time, to the last bit or nearly.
Points random_points(Random& random, int kind) {
  Points x;
  for (Vec3& p : x) {
    for (int axis = 0; axis < 3; ++axis) {
      const int whole = random.integer(-2, 2);
      const double noise = random.uniform();
      p[axis] = kind == 0 ? noise : kind == 2 ? whole + 0x1p-50 * noise : kind == 3 ? whole + 0x1p-10 * noise : whole;
      if (kind == 4 && axis > 0) p[axis] *= 0x1p-36;
    }
  }
  return x;
}

/// Makes x_t1 such that p meets the face (or its plane) at t = 1/4, 1/2 or 1: all numbers are small dyadic ones.
void make_contact(Random& random, Points& x_t0, Points& x_t1) {
  const double t = std::ldexp(1.0, -random.integer(0, 2));
  const double a = random.integer(0, 8) / 8.0, b = random.integer(0, 8) / 8.0;
  const auto at_t = [&](std::size_t i) -> Vec3 { return (1 - t) * x_t0[i] + t * x_t1[i]; };
  const Vec3 meeting = at_t(1) + a * (at_t(2) - at_t(1)) + b * (at_t(3) - at_t(1));
  x_t1[0] = x_t0[0] + (meeting - x_t0[0]) / t;
  if (random.chance(2)) x_t1[0][random.integer(0, 2)] *= 1 + 0x1p-52;
}

}  // namespace

void add_query_answers(Hash& hash) {
  Random random(61);
  for (int i = 0; i < kQueryCount; ++i) {
    const int kind = random.integer(0, 5);
    Points x_t0 = random_points(random, kind), x_t1 = random_points(random, kind);
    if (kind == 5) make_contact(random, x_t0, x_t1);
    const int exponent = random.chance(4) ? random.integer(-1070, 990) : 0;
    for (Points* x : {&x_t0, &x_t1}) {
      for (Vec3& p : *x) {
        for (double& coordinate : p) coordinate = std::ldexp(coordinate, exponent);
      }
    }
    CcdOptions options;
    if (random.chance(3)) options.tolerance = std::ldexp(1.0, exponent - random.integer(0, 40));
    if (random.chance(5)) options.max_intervals = random.integer(1, 50);
    hash.add(vf_ccd(x_t0, x_t1, options));
    hash.add(ee_ccd(x_t0, x_t1, options));
    hash.add(self_ccd({x_t0[0], x_t0[1], x_t0[2]}, {x_t1[0], x_t1[1], x_t1[2]}, options));
    hash.add(vf_proximity(x_t0));
    hash.add(ee_proximity(x_t1));
  }
}

}  // namespace selvage::testing
