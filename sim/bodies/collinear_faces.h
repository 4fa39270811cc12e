// Faces whose corners lie on one line: what polygons with a vertex within a side become, and what programs close
// T-junctions with. An edge of such a face runs along two others, as near as they are and with another name, and
// contact compares pairs by what they share (local_proximities.h): a sheet that slid over 60 x 30 polygons was 0.2 to
// 29 mm above them.
#pragma once

#include <cstdint>

#include "io/mesh_data.h"
#include "kernel/types.h"

namespace selvage::sim {

struct SplitFaces {
  io::Triangles triangles;
  std::int32_t resolved = 0;  ///< collinear ones that are gone
};

/// `triangles` with fewer such faces: those lower over their longest edge than a millionth of it. The surface stays
/// where it is to that millionth. The faces beyond that edge are split at the corner that lies on it, so that both
/// sides meet at the same edges; each pair of halves takes the places of the split face and of the one that is gone,
/// further ones come at the end. Where nothing is beyond it the face is left out if its other two edges are edges of
/// other faces, and stays if not, to stop cloth. O(#F), and up to the square of the number of such faces. x: #V by 3.
/// REQUIRES faces that name no vertex twice.
[[nodiscard]] SplitFaces split_at_collinear_corners(io::Triangles triangles, const Positions& x);

}  // namespace selvage::sim
