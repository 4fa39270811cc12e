// The baseline: continuous collision detection as the paper's section 6 describes it, in plain double precision.
//   Roots of the coplanarity cubic in [0,1], in increasing order, each followed by a proximity test within a fixed
//   tolerance, and the same test at t = 1. No error bound anywhere: it misses contacts (docs/guarantee-kernel.md says
//   why), and the benchmarks show how many, and what the proof costs beside it.
#pragma once

#include <array>

#include "kernel/types.h"

namespace selvage::bench {

/// The paper's rounding error tolerance: 1e-6 m.
inline constexpr double kTextbookTolerance = 1e-6;

struct TextbookAnswer {
  bool collides = false;
  double toi = 1;  ///< of the first root that passed the proximity test, or 1
};

/// x = {p, a, b, c}: point p against triangle (a, b, c). `tolerance` is a length, the same for queries of any size.
[[nodiscard]] TextbookAnswer textbook_vf(const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1,
                                         double tolerance = kTextbookTolerance);
/// x = {a, b, c, d}: edge (a, b) against edge (c, d).
[[nodiscard]] TextbookAnswer textbook_ee(const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1,
                                         double tolerance = kTextbookTolerance);

}  // namespace selvage::bench
