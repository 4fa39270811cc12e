#include "tests/verify/motion_families.h"

#include <cmath>
#include <cstdio>
#include <utility>

namespace selvage::verify::testbed {
namespace {

Point combine(const Point& a, double s, const Point& b) { return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

MotionCase generic(Draw& draw, int range) {
  MotionCase motion;
  for (auto* points : {&motion.x_t0, &motion.x_t1}) {
    for (Point& point : *points) point = draw.point(range);
  }
  return motion;
}

/// Shears with whole coefficients: keeps coplanarity, collinearity and whole numbers, and leaves no axis special.
void shear(Draw& draw, MotionCase& motion) {
  const int xy = draw.integer(-2, 2), yz = draw.integer(-2, 2), zx = draw.integer(-2, 2);
  for (auto* points : {&motion.x_t0, &motion.x_t1}) {
    for (Point& p : *points) {
      p[2] += zx * p[0];
      p[0] += xy * p[1];
      p[1] += yz * p[2];
    }
  }
}

MotionCase coplanar(Draw& draw, int range) {
  MotionCase motion = generic(draw, range);
  for (auto* points : {&motion.x_t0, &motion.x_t1}) {
    for (Point& point : *points) point[2] = 0;
  }
  shear(draw, motion);
  return motion;
}

MotionCase collinear(Draw& draw, int range) {
  MotionCase motion;
  const bool same_line = draw.chance(50);
  const Point origin = draw.point(range), direction = draw.point(range);
  for (auto* points : {&motion.x_t0, &motion.x_t1}) {
    const Point o = same_line ? origin : draw.point(range), d = same_line ? direction : draw.point(range);
    for (Point& point : *points) point = combine(o, draw.integer(-range, range), d);
  }
  return motion;
}

/// Two of the points are one: zero-length edges, zero-area triangles, a corner that is the other feature.
MotionCase coincident(Draw& draw, int range) {
  MotionCase motion = draw.chance(50) ? generic(draw, range) : coplanar(draw, range);
  const auto from = static_cast<std::size_t>(draw.integer(0, 3)), to = static_cast<std::size_t>(draw.integer(0, 3));
  if (draw.chance(80)) motion.x_t0[to] = motion.x_t0[from];
  if (draw.chance(80)) motion.x_t1[to] = motion.x_t1[from];
  return motion;
}

MotionCase at_rest(Draw& draw, int range) {
  MotionCase motion = draw.chance(50) ? generic(draw, range) : coplanar(draw, range);
  motion.x_t1 = motion.x_t0;
  return motion;
}

MotionCase common_velocity(Draw& draw, int range) {
  MotionCase motion = draw.chance(50) ? generic(draw, range) : coplanar(draw, range);
  const Point velocity = draw.point(range);
  for (std::size_t i = 0; i < 4; ++i) motion.x_t1[i] = combine(motion.x_t0[i], 1, velocity);
  return motion;
}

/// Edges (0,1) and (2,3) are parallel at both ends; with one direction, at all times; and they may share a plane.
MotionCase parallel(Draw& draw, int range) {
  MotionCase motion = draw.chance(50) ? generic(draw, range) : coplanar(draw, range);
  const Point common = draw.point(range);
  const bool one_direction = draw.chance(70);
  for (auto* points : {&motion.x_t0, &motion.x_t1}) {
    const Point direction = one_direction ? common : draw.point(range);
    (*points)[1] = combine((*points)[0], draw.integer(-2, 2), direction);
    (*points)[3] = combine((*points)[2], draw.integer(-2, 2), direction);
  }
  return motion;
}

/// The triangle (1,2,3) is collinear at both ends; with one direction, at all times.
MotionCase flat_triangle(Draw& draw, int range) {
  MotionCase motion = generic(draw, range);
  const Point common = draw.point(range);
  const bool one_direction = draw.chance(70);
  for (auto* points : {&motion.x_t0, &motion.x_t1}) {
    const Point direction = one_direction ? common : draw.point(range);
    for (const std::size_t corner : {2U, 3U}) {
      (*points)[corner] = combine((*points)[1], draw.integer(-3, 3), direction);
    }
  }
  return motion;
}

/// The middle of a hit in the interior, with opposite moves: the coplanarity cubic has symmetric, often repeated roots.
MotionCase symmetric(Draw& draw, int range) {
  MotionCase motion;
  for (std::size_t i = 0; i < 4; ++i) {
    const Point centre = i == 0 ? Point{} : draw.point(range), move = draw.point(range);
    motion.x_t0[i] = combine(centre, 1, move);
    motion.x_t1[i] = combine(centre, -1, move);
  }
  return motion;
}

constexpr Family kLattice[] = {
    {"generic", generic},     {"coplanar", coplanar},
    {"collinear", collinear}, {"coincident", coincident},
    {"at rest", at_rest},     {"common velocity", common_velocity},
    {"parallel", parallel},   {"flat triangle", flat_triangle},
    {"symmetric", symmetric},
};

MotionCase any_lattice(Draw& draw, int range) {
  return kLattice[draw.integer(0, static_cast<int>(std::size(kLattice)) - 1)].draw(draw, range);
}

template <class Change>
MotionCase with_coordinates(MotionCase motion, const Change& change) {
  for (auto* points : {&motion.x_t0, &motion.x_t1}) {
    for (Point& point : *points) {
      for (double& coordinate : point) coordinate = change(coordinate);
    }
  }
  return motion;
}

MotionCase last_bits(Draw& draw, int range) {
  return with_coordinates(any_lattice(draw, range), [&draw](double x) {
    if (draw.chance(70)) return x;
    return std::nextafter(x, draw.chance(50) ? 1e9 : -1e9);
  });
}

MotionCase thirds(Draw& draw, int range) {
  return with_coordinates(any_lattice(draw, range), [](double x) { return x / 3 + 1000; });
}

MotionCase exponents(Draw& draw, int range) {
  return with_coordinates(any_lattice(draw, range), [&draw](double x) { return std::ldexp(x, -draw.integer(0, 300)); });
}

/// Offset by 2^k, where sums of the small numbers round to few or no bits.
MotionCase offset(Draw& draw, int range) {
  const double far = std::ldexp(1.0, draw.integer(0, 54));
  return with_coordinates(any_lattice(draw, range), [far](double x) { return x + far; });
}

/// At both ends of the double range.
MotionCase scaled(Draw& draw, int range) {
  const int exponent = draw.chance(50) ? draw.integer(900, 1000) : -draw.integer(1060, 1074);
  return with_coordinates(any_lattice(draw, range), [exponent](double x) { return std::ldexp(x, exponent); });
}

/// Point 0 stays on the edge (1,2), or (2,3), exactly, in numbers so long that its distance from one end rounds:
/// products that cancel exactly leave their roundings.
MotionCase long_touch(Draw& draw, int /*range*/) {
  MotionCase motion;
  const bool is_last_edge = draw.chance(50);
  for (auto* points : {&motion.x_t0, &motion.x_t1}) {
    for (std::size_t k = 0; k < 3; ++k) {
      // An odd number e with 3 e > 2^53: the distance 3 e rounds, the ends s - 2 e and s + 2 e do not.
      const double e = 0x1p+51 * 1.5 + static_cast<double>(2 * (draw.bits() >> 15) + 1);
      const double sign = draw.chance(50) ? 1 : -1, s = 2.0 * draw.integer(-(1 << 20), 1 << 20);
      (*points)[0][k] = s + sign * e;
      (*points)[is_last_edge ? 2 : 1][k] = s - 2 * sign * e;
      (*points)[is_last_edge ? 3 : 2][k] = s + 2 * sign * e;
      (*points)[is_last_edge ? 1 : 3][k] = draw.integer(-(1 << 30), 1 << 30) * 0x1p+20;
    }
  }
  return motion;
}

/// Any exponents side by side, subnormals with the largest.
MotionCase whole_range(Draw& draw, int range) {
  return with_coordinates(any_lattice(draw, range),
                          [&draw](double x) { return draw.chance(50) ? x : std::ldexp(x, draw.integer(-1074, 1000)); });
}

constexpr Family kWholeRange[] = {{"whole range", whole_range}};
constexpr Family kDouble[] = {
    {"last bits", last_bits}, {"thirds + 1000", thirds}, {"mixed exponents", exponents},
    {"offset", offset},       {"scaled", scaled},        {"long touch", long_touch},
};

/// Whole weights that sum to `total`; zeros are frequent.
template <std::size_t N>
std::array<int, N> weights(Draw& draw, int total) {
  std::array<int, N> result{};
  for (int i = 0; i < total; ++i) ++result[static_cast<std::size_t>(draw.integer(0, N - 1))];
  return result;
}

constexpr int kWeightTotal = 3;
constexpr int kDenominators[] = {1, 2, 3, 5, 8};

/// A motion with sum signed_weights[i] x_i = 0 at a drawn time. All positions are free but one: the last of `moved`,
/// whose weight is not zero, is solved for. It is whole because all others are multiples of the denominator of the
/// solution.
PlantedHit plant(Draw& draw, int range, const std::array<int, 4>& signed_weights, std::size_t moved) {
  const int denominator = kDenominators[draw.integer(0, static_cast<int>(std::size(kDenominators)) - 1)];
  const int numerator = draw.integer(1, denominator);
  const int unit = numerator * signed_weights[moved];
  const int flat = draw.integer(1, 100);
  const std::size_t dimensions = flat <= 60 ? 3 : (flat <= 85 ? 2 : 1);

  MotionCase motion = generic(draw, range);
  for (std::size_t k = 0; k < 3; ++k) {
    double sum = 0;  // denominator * sum of the others' weighted positions at the time
    for (std::size_t i = 0; i < 4; ++i) {
      double &first = motion.x_t0[i][k], &last = motion.x_t1[i][k];
      first *= k < dimensions ? unit : 0;
      last *= k < dimensions ? unit : 0;
      if (i != moved) sum += signed_weights[i] * ((denominator - numerator) * first + numerator * last);
    }
    motion.x_t1[moved][k] =
        (-sum / signed_weights[moved] - (denominator - numerator) * motion.x_t0[moved][k]) / numerator;
  }
  shear(draw, motion);
  if (draw.chance(50)) return {motion, numerator, denominator};
  std::swap(motion.x_t0, motion.x_t1);
  return {motion, denominator - numerator, denominator};
}

}  // namespace

std::ostream& operator<<(std::ostream& out, const MotionCase& motion) {
  for (const auto* points : {&motion.x_t0, &motion.x_t1}) {
    out << (points == &motion.x_t0 ? "\nt = 0:" : "\nt = 1:");
    for (const Point& point : *points) {
      out << "\n ";
      for (const double coordinate : point) {
        std::array<char, 40> text{};
        std::snprintf(text.data(), text.size(), " %a", coordinate);
        out << text.data();
      }
    }
  }
  return out;
}

int Draw::integer(int first, int last) {
  const std::int64_t count = std::int64_t{last} - first + 1;
  return static_cast<int>(first + static_cast<std::int64_t>(engine_() % static_cast<std::uint64_t>(count)));
}

Point Draw::point(int range) {
  Point point{};
  for (double& coordinate : point) coordinate = integer(-range, range);
  return point;
}

MotionCase reordered(const MotionCase& motion, const std::array<std::size_t, 4>& order) {
  MotionCase result;
  for (std::size_t i = 0; i < 4; ++i) {
    result.x_t0[i] = motion.x_t0[order[i]];
    result.x_t1[i] = motion.x_t1[order[i]];
  }
  return result;
}

MotionCase half(const MotionCase& motion, bool second) {
  MotionCase result = motion;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      (second ? result.x_t0 : result.x_t1)[i][k] = (motion.x_t0[i][k] + motion.x_t1[i][k]) / 2;
    }
  }
  return result;
}

std::span<const Family> lattice_families() { return kLattice; }
std::span<const Family> double_families() { return kDouble; }
std::span<const Family> whole_range_families() { return kWholeRange; }

PlantedHit planted_vf_hit(Draw& draw, int range) {
  const auto w = weights<3>(draw, kWeightTotal);
  return plant(draw, range, {kWeightTotal, -w[0], -w[1], -w[2]}, 0);
}

PlantedHit planted_ee_hit(Draw& draw, int range) {
  const auto a = weights<2>(draw, kWeightTotal), b = weights<2>(draw, kWeightTotal);
  return plant(draw, range, {a[0], a[1], -b[0], -b[1]}, b[0] != 0 ? 2 : 3);
}

PlantedHit planted_self_hit(Draw& draw, int range) {
  const auto w = weights<2>(draw, kWeightTotal);
  return plant(draw, range, {kWeightTotal, -w[0], -w[1], 0}, 0);
}

MotionCase planted_miss(Draw& draw, int range, int first_count) {
  Point normal = draw.point(2);
  if (normal[0] == 0) normal[0] = 1;
  const bool flat = draw.chance(30);  // all in the plane z = 0 before the shift
  MotionCase motion = generic(draw, range);
  for (auto* points : {&motion.x_t0, &motion.x_t1}) {
    const Point shift = draw.point(range);
    for (std::size_t i = 0; i < 4; ++i) {
      Point& point = (*points)[i];
      if (flat) point[2] = 0;
      const bool on_first_side = static_cast<int>(i) < first_count;
      if ((dot(point, normal) > 0) != on_first_side) point = {-point[0], -point[1], -point[2]};
      if (on_first_side && dot(point, normal) == 0) point[0] += normal[0];
      point = combine(point, 1, shift);
    }
  }
  return motion;
}

}  // namespace selvage::verify::testbed
