#include "sim/bodies/attachment.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "kernel/assert.h"
#include "kernel/proximity.h"
#include "sim/base/rigid_motion.h"

namespace selvage::sim {
namespace {

using Face = std::array<VertexId, 3>;
using Corners = std::array<Vec3, 3>;

Corners corners_of(const Face& face, const PositionsRef& x) {
  return {Vec3(x.row(face[0])), Vec3(x.row(face[1])), Vec3(x.row(face[2]))};
}

struct Ball {
  Vec3 center = Vec3::Zero();
  double radius = 0;
};

Ball ball_around(const Corners& corners) {
  const Vec3 center = (corners[0] + corners[1] + corners[2]) / 3;
  double radius = 0;
  for (const Vec3& corner : corners) radius = std::max(radius, (corner - center).norm());
  return {center, radius};
}

}  // namespace

Attachment::Attachment(Positions points, std::span<const Face> faces, const PositionsRef& x)
    : points_(std::move(points)) {
  SELVAGE_ASSERT(!faces.empty());
  std::vector<Ball> balls;
  for (const Face& face : faces) balls.push_back(ball_around(corners_of(face, x)));
  for (const auto& row : points_.rowwise()) {
    const Vec3 point(row);
    Anchor nearest;
    double distance = std::numeric_limits<double>::infinity();
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if ((point - balls[f].center).norm() - balls[f].radius >= distance) continue;
      const Corners corners = corners_of(faces[f], x);
      const Proximity found = vf_proximity({point, corners[0], corners[1], corners[2]});
      if (found.distance >= distance) continue;
      distance = found.distance;
      nearest = {faces[f], corners, {found.weights[1], found.weights[2], found.weights[3]}};
    }
    anchors_.push_back(nearest);
  }
}

Positions Attachment::placed_on(const PositionsRef& x) const {
  Positions placed = points_;
  for (std::size_t i = 0; i < anchors_.size(); ++i) {
    const Anchor& anchor = anchors_[i];
    const Corners now = corners_of(anchor.face, x);
    Vec3 from_foot(points_.row(static_cast<Eigen::Index>(i))), shift = Vec3::Zero();
    for (std::size_t k = 0; k < 3; ++k) {
      from_foot -= anchor.weights[k] * anchor.corners[k];
      shift += anchor.weights[k] * (now[k] - anchor.corners[k]);
    }
    placed.row(static_cast<Eigen::Index>(i)) += shift + best_fit_motion(anchor.corners, now).turn * from_foot;
  }
  return placed;
}

}  // namespace selvage::sim
