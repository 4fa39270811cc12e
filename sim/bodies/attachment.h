// What a pin with a body holds: vertices of cloth that the body carries, a rigid one or one that deforms.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "kernel/types.h"

namespace selvage::sim {

class Attachment {
 public:
  /// Every row of `points` hangs on the point of `faces`, at least one, that is nearest to it; x: where the vertices of
  /// the body are meanwhile, of which the faces name the rows; what follows them is not looked at. O(points faces), 3
  /// ns each where most faces are too far to be asked.
  Attachment(Positions points, std::span<const std::array<VertexId, 3>> faces, const PositionsRef& x);

  /// Where the points are when x has the vertices of the body: each keeps its distance from its point of the body, and
  /// turns about that as the face there turns, best in least squares. Up to rounding a rigid motion where the body's is
  /// one; `points` to the bit where that is at rest.
  [[nodiscard]] Positions placed_on(const PositionsRef& x) const;
  [[nodiscard]] Eigen::Index count() const { return points_.rows(); }

 private:
  struct Anchor {
    std::array<VertexId, 3> face;
    std::array<Vec3, 3> corners;    ///< at the start
    std::array<double, 3> weights;  ///< of the nearest point
  };
  Positions points_;
  std::vector<Anchor> anchors_;
};

}  // namespace selvage::sim
