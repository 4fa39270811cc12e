// Boxes of what moves, and eight of them side by side for one test against a ninth.
#pragma once

#include <array>
#include <cstddef>
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

/// The boxes of what goes straight on at some of its instants, its first and last among them, in order. Two *may meet*
/// unless along one axis they are apart on the same side at all of these: then they are at any time, since the
/// difference of two coordinates is linear in time.
template <std::size_t kInstants>
using Boxes = std::array<Box, kInstants>;

/// The smallest box that holds `points`. REQUIRES at least one.
[[nodiscard]] Box bounding_box(std::span<const Point> points);
/// At least `distance` larger on every side; rounds outward.
[[nodiscard]] Box grown(const Box& box, double distance);

/// Coordinates of boxes as 32-bit integers by one non-decreasing map for all boxes of an instant: those that may meet
/// still may.
struct Lattice {
  Point origin_half{};
  double scale = 1;

  [[nodiscard]] std::int32_t operator()(std::size_t axis, double x) const;
  /// The finest lattice that holds `bounds`.
  static Lattice over(const Box& bounds);
};

template <std::size_t kInstants>
using Lattices = std::array<Lattice, kInstants>;

struct LatticeBox {
  std::array<std::int32_t, 3> min, max;
};

template <std::size_t kInstants>
using LatticeBoxes = std::array<LatticeBox, kInstants>;
template <std::size_t kInstants>
[[nodiscard]] LatticeBoxes<kInstants> on_lattices(const Lattices<kInstants>& lattices, const Boxes<kInstants>& boxes);

/// Eight times Boxes side by side; places that are not used meet nothing.
template <std::size_t kInstants>
struct alignas(64) BoxBlock {
  static constexpr std::size_t kWidth = 8;
  using Columns = std::array<std::array<std::int32_t, kWidth>, 3>;
  std::array<Columns, kInstants> min, max;

  BoxBlock();
  void set(std::size_t place, const LatticeBoxes<kInstants>& boxes);
  [[nodiscard]] LatticeBoxes<kInstants> get(std::size_t place) const;
  [[nodiscard]] LatticeBoxes<kInstants> bounds() const;
  /// Bit i: the boxes at place i may meet `boxes`.
  [[nodiscard]] unsigned meet_mask(const LatticeBoxes<kInstants>& boxes) const;
};

#if defined(__SSE2__)
template <std::size_t kInstants>
unsigned BoxBlock<kInstants>::meet_mask(const LatticeBoxes<kInstants>& boxes) const {
  const auto load = [](const Columns& columns, std::size_t k, std::size_t half) {
    return _mm_load_si128(reinterpret_cast<const __m128i*>(&columns[k][half]));
  };
  const auto apart_along = [&](std::size_t k, std::size_t half) {
    __m128i above = _mm_cmpgt_epi32(load(min[0], k, half), _mm_set1_epi32(boxes[0].max[k]));
    __m128i below = _mm_cmpgt_epi32(_mm_set1_epi32(boxes[0].min[k]), load(max[0], k, half));
    for (std::size_t i = 1; i < kInstants; ++i) {
      above = _mm_and_si128(above, _mm_cmpgt_epi32(load(min[i], k, half), _mm_set1_epi32(boxes[i].max[k])));
      below = _mm_and_si128(below, _mm_cmpgt_epi32(_mm_set1_epi32(boxes[i].min[k]), load(max[i], k, half)));
    }
    return _mm_or_si128(above, below);
  };
  // Written out: as a loop it takes twice the time (measured, GCC 12 -O2).
  const auto apart = [&](std::size_t half) {
    const __m128i any = _mm_or_si128(_mm_or_si128(apart_along(0, half), apart_along(1, half)), apart_along(2, half));
    return static_cast<unsigned>(_mm_movemask_ps(_mm_castsi128_ps(any)));
  };
  return ~(apart(0) | apart(4) << 4) & 0xffU;
}
#else
template <std::size_t kInstants>
unsigned BoxBlock<kInstants>::meet_mask(const LatticeBoxes<kInstants>& boxes) const {
  unsigned mask = 0;
  for (std::size_t place = 0; place < kWidth; ++place) {
    unsigned apart = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      unsigned above = 1, below = 1;
      for (std::size_t i = 0; i < kInstants; ++i) {
        above &= static_cast<unsigned>(min[i][k][place] > boxes[i].max[k]);
        below &= static_cast<unsigned>(boxes[i].min[k] > max[i][k][place]);
      }
      apart |= above | below;
    }
    mask |= (1U - apart) << place;
  }
  return mask;
}
#endif

}  // namespace selvage::verify
