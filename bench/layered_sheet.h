// Cloth folded over itself many times, and its motion: what the checker is measured on.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "verify/arithmetic/point.h"

namespace selvage::bench {

struct LayeredSheet {
  std::vector<std::array<std::int32_t, 3>> triangles;
  std::vector<verify::Point> V_t0, V_t1;
  double gap = 0;  ///< of neighbouring layers, along the direction in which they are stacked
  int layers = 0;
};

/// One connected sheet of about `faces` faces in a serpentine of `layers` layers, each about 1 by 1: crumpled by waves
/// and noise that all layers share, roughened by a tenth of the gap, turned to lie along no axis. The gap is 0.135 of
/// an edge. From t = 0 to 1 all of it drifts smoothly by up to 0.002. Free of intersections, at rest and in motion.
/// Deterministic. REQUIRES faces >= 100, layers >= 2.
[[nodiscard]] LayeredSheet layered_sheet(int faces, int layers);

/// Moves `count` vertices, spread over the first half of the layers, towards the next layer by `distance`.
void poke(std::vector<verify::Point>& V, int count, double distance);

}  // namespace selvage::bench
