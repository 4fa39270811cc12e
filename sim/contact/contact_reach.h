// How far apart two points of the surface may be and still be a contact, and how near they may come.
#pragma once

#include <algorithm>

namespace selvage::sim {

/// Pairs are contacts up to this many thicknesses; the paper's are up to one. Cloth that rests is lifted to the end of
/// its contacts by any swing. Where they end at the thickness it then falls free for a step, and starts the next swing:
/// cloth over the edge of a box (case cliff-edge, 8 x 8 vertices) moved by 6 mm in the fifth second, whatever the
/// friction, and by 0.04 mm with a second thickness (18 x 18: 3.7 and 0.7 mm). In half of one it falls through, 2.7 mm
/// in 1/60 s against 2 mm there. Steps grow longer with it, because less collides: sim/scenes/curtain.toml as a draft
/// takes 1211 steps, 23 of them with collisions, where it took 2253 and 476; with a third thickness 1471 and 627,
/// in 1.4 times the processor time.
inline constexpr double kContactReach = 2;

/// How far a pair that overlaps by `overlap` (thickness less distance) may still approach: to the thickness; m, >= 0.
[[nodiscard]] inline double room_to_approach(double overlap) { return std::max(-overlap, 0.0); }

}  // namespace selvage::sim
