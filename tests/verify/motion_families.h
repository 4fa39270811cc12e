// Families of four-point motions that reach every branch of the exact decision; deterministic for a seed.
#pragma once

#include <cstdint>
#include <ostream>
#include <random>
#include <span>

#include "verify/decision/exact_motion.h"

namespace selvage::verify::testbed {

struct MotionCase {
  std::array<Point, 4> x_t0{}, x_t1{};
  [[nodiscard]] std::array<Point, 3> three_t0() const { return {x_t0[0], x_t0[1], x_t0[2]}; }
  [[nodiscard]] std::array<Point, 3> three_t1() const { return {x_t1[0], x_t1[1], x_t1[2]}; }
};
/// As hex floats, a point a line: bits, to be pasted into a test.
std::ostream& operator<<(std::ostream& out, const MotionCase& motion);

/// Point i is that of order[i].
[[nodiscard]] MotionCase reordered(const MotionCase& motion, const std::array<std::size_t, 4>& order);

/// The first half of the motion, or the second; its times are twice the whole one's, or twice minus one. REQUIRES even
/// coordinates that doubles hold with a bit to spare.
[[nodiscard]] MotionCase half(const MotionCase& motion, bool second);

/// The same numbers from every standard library (its distributions differ).
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : engine_(seed) {}
  std::uint64_t bits() { return engine_(); }
  /// Uniform in first..last, up to a bias below 2^-40.
  int integer(int first, int last);
  bool chance(int percent) { return integer(1, 100) <= percent; }
  /// Whole coordinates in [-range, range].
  Point point(int range);

 private:
  std::mt19937_64 engine_;
};

struct Family {
  const char* name;
  MotionCase (*draw)(Draw& draw, int range);
};
/// Small whole numbers, made degenerate in one way each: coordinates below 2^20 for a range up to 10.
[[nodiscard]] std::span<const Family> lattice_families();
/// Doubles that are not whole: last bits, rounded thirds far from the origin, exponents far apart.
[[nodiscard]] std::span<const Family> double_families();
/// Exponents over the whole range of doubles: exact arithmetic on numbers of thousands of bits.
[[nodiscard]] std::span<const Family> whole_range_families();

/// Motions that touch at the time numerator / denominator: a point of positive or zero whole weights is planted.
struct PlantedHit {
  MotionCase motion;
  int numerator = 0, denominator = 1;
};
[[nodiscard]] PlantedHit planted_vf_hit(Draw& draw, int range);
[[nodiscard]] PlantedHit planted_ee_hit(Draw& draw, int range);
[[nodiscard]] PlantedHit planted_self_hit(Draw& draw, int range);

/// Motions whose features stay on different sides of a plane. The first `first_count` points are on one side.
[[nodiscard]] MotionCase planted_miss(Draw& draw, int range, int first_count);

}  // namespace selvage::verify::testbed
