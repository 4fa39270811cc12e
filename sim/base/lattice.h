// The lattice that positions are stored on: all doubles, or those that a float32 holds.
#pragma once

#include "kernel/types.h"

namespace selvage::sim {

enum class Precision { kFloat64, kFloat32 };

/// The nearest number of the lattice within the domain: |x| <= kMaxCoordinate, or <= the largest float32.
[[nodiscard]] double to_lattice(double x, Precision precision);
/// The same of every coordinate.
[[nodiscard]] Positions to_lattice(const PositionsRef& x, Precision precision);
/// Without that bound, for what a scene states: beyond the largest float32 is infinite, which no step accepts.
[[nodiscard]] Positions rounded(Positions x, Precision precision);

}  // namespace selvage::sim
