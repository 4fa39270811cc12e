// Axis-aligned boxes of moving features: the one definition of "boxes overlap" that every broad phase shares (K6).
//   The box of a vertex holds its two end positions, hence its straight path; it is grown by reach / 2. The box of an
//   edge or a face is the union of its vertices' boxes, hence holds the feature at every t in [0, 1].
//   Two features nearer than `reach` at one t differ by at most `reach` along each axis, so their boxes overlap.
//   A moving box is one at each end instead. What moves on straight paths and is above another along an axis at both
//   ends is above it at every t: such pairs are apart, however far both have gone.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "kernel/types.h"

namespace selvage {

struct Box {  ///< closed; empty until merged with something
  std::array<double, 3> lower{kInfinity, kInfinity, kInfinity};
  std::array<double, 3> upper{-kInfinity, -kInfinity, -kInfinity};

  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  void merge(const Box& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], other.lower[axis]);
      upper[axis] = std::max(upper[axis], other.upper[axis]);
    }
  }
  friend Box united(Box a, const Box& b) {
    a.merge(b);
    return a;
  }
  /// Closed: boxes that share one face, edge or corner overlap.
  friend bool overlap(const Box& a, const Box& b) {
    return a.lower[0] <= b.upper[0] && b.lower[0] <= a.upper[0] &&  //
           a.lower[1] <= b.upper[1] && b.lower[1] <= a.upper[1] &&  //
           a.lower[2] <= b.upper[2] && b.lower[2] <= a.upper[2];
  }
};

/// A feature's boxes at t = 0 and t = 1; the same box twice stands for all of its way.
struct MovingBox {
  Box t0, t1;

  void merge(const MovingBox& other) {
    t0.merge(other.t0);
    t1.merge(other.t1);
  }
  friend MovingBox united(MovingBox a, const MovingBox& b) {
    a.merge(b);
    return a;
  }
  /// Unless one is above the other along one axis at both ends. Of the same boxes twice that is `overlap` of boxes.
  friend bool overlap(const MovingBox& a, const MovingBox& b) {
    const auto reaches = [](const MovingBox& below, const MovingBox& above, std::size_t axis) {
      return above.t0.lower[axis] <= below.t0.upper[axis] || above.t1.lower[axis] <= below.t1.upper[axis];
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!reaches(a, b, axis) || !reaches(b, a, axis)) return false;
    }
    return true;
  }
};

/// A vertex on its way from row v of V_t0 to row v of V_t1, grown by reach / 2. With reach = 0 the box is exact. Else
/// each bound is rounded outward, by less than two units in the last place. Growth is monotone: growing before uniting
/// equals growing after it.
/// REQUIRES a finite reach >= 0, |coordinate| <= kMaxCoordinate: then no bound overflows. The caller holds an
/// FpEnvGuard: here stands all arithmetic of the broad phase (the rest compares), and as it is not inlined none of it
/// can be moved out of the guard's scope.
[[nodiscard, gnu::noinline]] Box vertex_box(const PositionsRef& V_t0, const PositionsRef& V_t1, VertexId v,
                                            double reach);

/// How far one box holds a motion.
enum class MotionBoxes : std::uint8_t {
  kSwept,  ///< all of the way
  kMoving  ///< one for each end
};
/// Swept, the same box twice.
[[nodiscard]] MovingBox vertex_box(const PositionsRef& V_t0, const PositionsRef& V_t1, VertexId v, double reach,
                                   MotionBoxes boxes);

}  // namespace selvage
