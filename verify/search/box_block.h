// Boxes, and eight of them side by side for one test against a ninth.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "verify/arithmetic/point.h"

namespace selvage::verify {

/// Closed; min and max of coordinates do not round.
struct Box {
  Point min, max;

  [[nodiscard]] bool overlaps(const Box& other) const {
    unsigned apart = 0;  // without branches: which of the six fails first cannot be predicted
    for (std::size_t k = 0; k < 3; ++k) {
      apart |= static_cast<unsigned>(min[k] > other.max[k]) | static_cast<unsigned>(other.min[k] > max[k]);
    }
    return apart == 0;
  }
};

/// The smallest box that holds `points`. REQUIRES at least one.
[[nodiscard]] Box bounding_box(std::span<const Point> points);
/// At least `distance` larger on every side; rounds outward.
[[nodiscard]] Box grown(const Box& box, double distance);

/// Coordinates of boxes as 32-bit integers by one non-decreasing map for all, so boxes that overlap still do.
struct Lattice {
  Point origin_half{};
  double scale = 1;

  [[nodiscard]] std::int32_t operator()(std::size_t axis, double x) const;
  /// The finest lattice that holds `bounds`.
  static Lattice over(const Box& bounds);
};

struct LatticeBox {
  std::array<std::int32_t, 3> min, max;
};

/// Eight boxes side by side; places that are not used overlap nothing.
struct alignas(64) BoxBlock {
  static constexpr std::size_t kWidth = 8;
  std::array<std::array<std::int32_t, kWidth>, 3> min, max;

  BoxBlock();
  void set(std::size_t place, const LatticeBox& box);
  [[nodiscard]] LatticeBox get(std::size_t place) const;
  [[nodiscard]] LatticeBox bounds() const;
  /// Bit i: the box at place i overlaps `box`.
  [[nodiscard]] unsigned overlap_mask(const LatticeBox& box) const;
};

#if defined(__SSE2__)
inline unsigned BoxBlock::overlap_mask(const LatticeBox& box) const {
  const auto apart_along = [&](std::size_t k, std::size_t half) {
    const __m128i low = _mm_load_si128(reinterpret_cast<const __m128i*>(&min[k][half]));
    const __m128i high = _mm_load_si128(reinterpret_cast<const __m128i*>(&max[k][half]));
    return _mm_or_si128(_mm_cmpgt_epi32(low, _mm_set1_epi32(box.max[k])),
                        _mm_cmpgt_epi32(_mm_set1_epi32(box.min[k]), high));
  };
  // Written out: as a loop it takes twice the time (measured, GCC 12 -O2).
  const auto apart = [&](std::size_t half) {
    const __m128i any = _mm_or_si128(_mm_or_si128(apart_along(0, half), apart_along(1, half)), apart_along(2, half));
    return static_cast<unsigned>(_mm_movemask_ps(_mm_castsi128_ps(any)));
  };
  return ~(apart(0) | apart(4) << 4) & 0xffU;
}
#else
inline unsigned BoxBlock::overlap_mask(const LatticeBox& box) const {
  unsigned mask = 0;
  for (std::size_t i = 0; i < kWidth; ++i) {
    unsigned apart = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      apart |= static_cast<unsigned>(min[k][i] > box.max[k]) | static_cast<unsigned>(box.min[k] > max[k][i]);
    }
    mask |= (1U - apart) << i;
  }
  return mask;
}
#endif

}  // namespace selvage::verify
