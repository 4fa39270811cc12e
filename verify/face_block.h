// The first filter of the frame check: a face against eight others at once, in single precision with proved bounds.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "verify/float_frame.h"

namespace selvage::verify {

/// A face in a FloatFrame. `direction` is nearly normal to it, and for every other point x of the frame
///   direction . x, as computed, > high  implies  x lies strictly above the plane of the face, and < low strictly below
/// ("above": where its exact normal points). A face of zero area has no such x.
struct FloatFace {
  std::array<std::array<float, 3>, 3> corners;  ///< [corner][axis]
  std::array<float, 3> direction;
  float low, high;
  std::array<std::int32_t, 3> vertices;
  std::array<float, 3> min, max;  ///< of the corners; rounding kept their order, so boxes that overlap still do

  FloatFace() = default;
  FloatFace(const std::array<std::int32_t, 3>& triangle, std::span<const Point> V, const FloatFrame& frame);
};

struct FaceQuery;

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
  [[nodiscard]] FloatFace get(std::size_t place) const;

  /// About one face and the eight: bit i is about the face at place i.
  struct Masks {
    /// The stored boxes have a point in common: so do all whose exact boxes have.
    unsigned meet = 0;
    /// Of these: proved that the exact boxes have, and that the faces have none but corners shared by index.
    unsigned apart = 0;
  };
  /// masks[i], for all bits i of the result, is about face i of `query`; for the others no boxes meet. `min`, `max`: a
  /// box that holds all eight. The same on every processor.
  [[nodiscard]] unsigned compare(const FaceQuery& query, const std::array<float, 3>& min,
                                 const std::array<float, 3>& max, std::array<Masks, kWidth>& masks) const;
};

/// The faces of a block, one by one and their boxes side by side: what is asked about against many other blocks.
struct FaceQuery {
  std::array<FloatFace, FaceBlock::kWidth> faces;
  std::array<FaceBlock::Lanes<float>, 3> min, max;

  explicit FaceQuery(const FaceBlock& block);
};

}  // namespace selvage::verify
