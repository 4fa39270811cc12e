// Vertices that lie at one place, without any tolerance, in every frame: writers split them at seams and corners.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "verify/arithmetic/point.h"

namespace selvage::verify {

/// Shown every frame, knows which vertices never part. Places are equal as numbers are: -0, which mirroring leaves at a
/// seam, is 0.
class Weld {
 public:
  /// A frame more. Throws std::invalid_argument if it has another number of vertices than the first one. The first
  /// frame costs O(#V log #V), the others a share of it: only those that still coincide are looked at.
  void narrow(std::span<const Point> V);

  /// For every vertex the lowest-numbered one that it never parts from. REQUIRES at least one frame.
  [[nodiscard]] std::vector<std::int32_t> representatives() const;

 private:
  std::size_t vertex_count_ = 0;
  bool has_frame_ = false;
  std::vector<std::vector<std::int32_t>> together_;  // ascending, at least two each
};

/// Faces after welding: a corner has the name of its representative, unless another corner of the face has it already.
/// So a face of which two corners became one still has three names, for the same points. It has zero area in every
/// frame, and is listed.
struct WeldedFaces {
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<std::int32_t> collapsed;
};
/// REQUIRES faces that do not repeat a corner.
[[nodiscard]] WeldedFaces weld_faces(std::span<const std::array<std::int32_t, 3>> triangles,
                                     std::span<const std::int32_t> representatives);

}  // namespace selvage::verify
