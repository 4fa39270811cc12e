#include "kernel/box.h"

#include <bit>
#include <cstdint>

namespace selvage {

namespace {

/// nextafter(x, infinity) for finite x, without the call: a refit makes six steps a vertex.
double next_above(double x) {
  const auto bits = std::bit_cast<std::int64_t>(x + 0.0);  // -0 becomes 0
  return std::bit_cast<double>(bits >= 0 ? bits + 1 : bits - 1);
}
double next_below(double x) { return -next_above(-x); }

}  // namespace

// Subtracting rounds by at most half a unit in the last place u, and halving `reach` by at most 2^-1075; one step
// to the next double makes up for both. The step is u, hence enough, except below a power of two, where it is u / 2;
// but there the subtraction rounded down by a quarter of u at most, because below a power of two doubles are twice as
// dense. For subnormal results the subtraction is exact.
Box vertex_box(const PositionsRef& V_t0, const PositionsRef& V_t1, VertexId v, double reach) {
  Box box;
  const double growth = 0.5 * reach;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto column = static_cast<Eigen::Index>(axis);
    const auto [lower, upper] = std::minmax({V_t0(v, column), V_t1(v, column)});
    box.lower[axis] = reach == 0 ? lower : next_below(lower - growth);
    box.upper[axis] = reach == 0 ? upper : next_above(upper + growth);
  }
  return box;
}

MovingBox vertex_box(const PositionsRef& V_t0, const PositionsRef& V_t1, VertexId v, double reach, MotionBoxes boxes) {
  if (boxes == MotionBoxes::kMoving) return {vertex_box(V_t0, V_t0, v, reach), vertex_box(V_t1, V_t1, v, reach)};
  const Box swept = vertex_box(V_t0, V_t1, v, reach);
  return {swept, swept};
}

}  // namespace selvage
