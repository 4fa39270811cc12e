// The springs and masses of one cloth, from the shape that it has at rest (paper, section 3).
#pragma once

#include <vector>

#include "sim/scene/scene.h"
#include "sim/scene/shapes.h"
#include "sim/springs/spring.h"
#include "sim/springs/stabilizer.h"

namespace selvage::sim {

/// Springs between the vertices of `rest`, numbered from 0. A sheet gets structural springs along the grid, shear
/// springs along both diagonals and bending springs to every other node; a general mesh gets structural springs along
/// its edges and bending springs between the two vertices opposite an edge that two faces share. Springs of stiffness
/// zero are not made. Damping is damping_ratio times each spring's critical damping 2 sqrt(k m), m the reduced mass.
/// `mass_kg` is that of cloth_masses.
[[nodiscard]] std::vector<Spring> make_springs(const ClothSpec& spec, const Shape& rest,
                                               const std::vector<double>& mass_kg);

/// A stabiliser for every middle node of a sheet's bending springs, or for every inner edge of a mesh, at rest where
/// the cloth is flat. None for stiffness zero. Damping as above, with the reduced mass 1 / sum of w^2 / m.
[[nodiscard]] std::vector<Stabilizer> make_stabilizers(const ClothSpec& spec, const Shape& rest,
                                                       const std::vector<double>& mass_kg);

/// density times area in all, shared equally by the vertices of faces (section 3: "giving all particles the same mass")
/// or by a third of the adjacent faces' areas. In the first case one of no face gets as much beside that, else nothing.
[[nodiscard]] std::vector<double> cloth_masses(const ClothSpec& spec, const Shape& rest);

}  // namespace selvage::sim
