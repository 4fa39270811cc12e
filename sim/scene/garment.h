// A garment as one triangle mesh: a tube of elliptical rings from the neck down to the hem, with or without a pair of
// sleeves. A skirt is a short one, a robe a long one with wide sleeves.
#pragma once

#include <cstddef>
#include <optional>
#include <stdexcept>
#include <vector>

#include "sim/scene/shapes.h"

namespace selvage::sim {

/// Up is +z, the front +x, the left side +y; symmetric in y.
struct GarmentSpec {
  struct Ring {
    double height_m = 0;              ///< of its plane
    double depth_m = 0, width_m = 0;  ///< of the ellipse, along x and y
  };
  /// Straight from an opening in each side, which is a rectangle of cells, to a round cuff at right angles to them.
  struct Sleeves {
    double top_m = 0, bottom_m = 0;  ///< heights of the opening
    double depth_m = 0;              ///< of the opening, along x
    double length_m = 0;             ///< from the middle of the opening to that of the cuff
    double cuff_radius_m = 0;
    double down_deg = 0;  ///< how far below the horizontal they point
  };
  std::vector<Ring> rings;  ///< at least two, from the top down; straight lines between them
  std::optional<Sleeves> sleeves;
  std::size_t sleeves_line = 0;  ///< in the scene file; whether they fit shows only when they are cut
  double cell_m = 0;             ///< side of a cell, on average
};

/// What cannot be cut: an opening that is not inside the tube, or is smaller than the cells.
class GarmentError : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

/// Faces are counter-clockwise seen from outside. The borders are the neck, the hem and the cuffs; every other edge has
/// two faces. Without intersection unless sleeves and tube are made to run into each other. REQUIRES positive sizes,
/// rings of falling height.
[[nodiscard]] Shape make_garment(const GarmentSpec& spec);

}  // namespace selvage::sim
