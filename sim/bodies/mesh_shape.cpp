#include "sim/bodies/mesh_shape.h"

#include "sim/scene/scene_ranges.h"

namespace selvage::sim {

Positions scaled_positions(const io::Points& points, double scale, std::string_view name) {
  Positions x(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double scaled = scale * points[i][k];
      if (!inside(scaled, kCoordinate)) {
        throw io::Error(io::ErrorKind::kBadInput,
                        fmt::format("vertex {} of {} has the coordinate {:g}, with the scale {:g} beyond {:g} m; lower "
                                    "scale or correct the file",
                                    i, name, points[i][k], scale, kCoordinate.upper));
      }
      x(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)) = scaled;
    }
  }
  return x;
}

}  // namespace selvage::sim
