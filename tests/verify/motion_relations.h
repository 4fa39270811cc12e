// Relations that an exact decision of a motion must satisfy, whatever the answer is: asked of the integer decision
// itself, without the filter, which would hide it on simple motions. Each returns what is broken, or nothing.
#pragma once

#include <string>

#include "tests/verify/motion_families.h"

namespace selvage::verify::testbed {

[[nodiscard]] std::string broken_by_time_reversal(const MotionCase& motion);
/// Corners of the face in another order, ends of an edge exchanged, the edges exchanged.
[[nodiscard]] std::string broken_by_order(const MotionCase& motion);
/// Axis cycle, scale, reflection, a rational rotation, a shear. REQUIRES coordinates that these leave exact.
[[nodiscard]] std::string broken_by_maps(const MotionCase& motion);
/// REQUIRES coordinates of few bits.
[[nodiscard]] std::string broken_by_common_motion(const MotionCase& motion, Draw& shifts);
/// [0, 1/2], [1/2, 1] and [0, 2/3] against the whole. REQUIRES whole coordinates of few bits.
[[nodiscard]] std::string broken_by_split(const MotionCase& motion);

}  // namespace selvage::verify::testbed
