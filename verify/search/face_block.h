// Faces as the first filter of the frame check reads them, in single precision with proved bounds: one, or eight side
// by side.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "verify/search/float_frame.h"

namespace selvage::verify {

/// A face in a FloatFrame. `direction` is nearly normal to it, and for every other point x of the frame
///   direction . x, as computed, > high  implies  x lies strictly above the plane of the face, and < low strictly below
/// ("above": where its exact normal points). A face of zero area has no such x, nor one of which the frame does not
/// hold a corner: for this one `high` is infinite, and its stored corners prove nothing about other faces but where its
/// box is.
struct FloatFace {
  std::array<std::array<float, 3>, 3> corners;  ///< [corner][axis]
  std::array<float, 3> direction;
  float low, high;
  std::array<std::int32_t, 3> vertices;
  std::array<float, 3> min, max;  ///< of the corners; rounding kept their order, so boxes that overlap still do

  FloatFace() = default;
  FloatFace(const std::array<std::int32_t, 3>& triangle, std::span<const Point> V, const FloatFrame& frame);
};

/// Eight of them side by side; places that are not used overlap nothing.
struct alignas(32) FaceBlock {
  static constexpr std::size_t kWidth = 8;
  template <class T>
  using Lanes = std::array<T, kWidth>;

  std::array<std::array<Lanes<float>, 3>, 3> corners;  ///< [corner][axis][place]
  std::array<Lanes<float>, 3> direction;
  Lanes<float> low, high;
  std::array<Lanes<std::int32_t>, 3> vertices;

  FaceBlock();
  void set(std::size_t place, const FloatFace& face);
};

/// The box of all faces of a block.
struct FaceBounds {
  std::array<float, 3> min{2, 2, 2}, max{-2, -2, -2};  ///< of none: beyond the frame
};

/// Eight boxes side by side.
struct alignas(32) FaceBoxes {
  std::array<FaceBlock::Lanes<float>, 3> min, max;
};

}  // namespace selvage::verify
