// The first filter of the frame check: for every face the slab between two planes parallel to it, made once a frame.
// Faces on different sides of a slab, or of a plane between their centers, are apart.
#pragma once

#include <span>
#include <vector>

#include "verify/topology.h"

namespace selvage::verify {

class FaceSlabs {
 public:
  /// The spans must outlive it. REQUIRES finite positions.
  FaceSlabs(std::span<const std::array<std::int32_t, 3>> triangles, std::span<const Point> V);

  /// True is a proof that the faces have no point in common; false means "do not know". For faces with a common vertex
  /// it is always false.
  [[nodiscard]] bool triage_apart(std::int32_t f, std::int32_t g) const;

 private:
  /// direction . x, as computed for any point x of another face, is beyond low and high only if that point is beyond
  /// all of this face.
  struct Slab {
    Point direction;
    double low, high;
  };
  struct Corners {
    const Point &a, &b, &c;
  };
  [[nodiscard]] Corners corners(std::int32_t face) const;
  /// Whether the corners lie strictly on one side of the slab.
  static bool outside(const Slab& slab, const Corners& x);
  [[nodiscard]] bool center_plane_between(const Corners& x, const Corners& y) const;

  std::span<const std::array<std::int32_t, 3>> triangles_;
  std::span<const Point> V_;
  Point largest_{};  // per axis, of the magnitudes of all coordinates
  std::vector<Slab> slabs_;
};

}  // namespace selvage::verify
