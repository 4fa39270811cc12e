// The queries of ccd.h and proximity.h without the guard, for loops that hold one FpEnvGuard a task.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "kernel/ccd.h"
#include "kernel/proximity.h"

namespace selvage::detail {

/// Whether the bounds hold for these points; false for NaN.
[[nodiscard]] inline bool in_domain(std::span<const Vec3> points) {
  return std::ranges::all_of(points, [](const Vec3& x) { return (x.array().abs() <= kMaxCoordinate).all(); });
}

/// As the public functions. REQUIRES the environment of FpEnvGuard. Not inlined: the compiler does not know that
/// arithmetic depends on a guard, and may move what stands beside one out of its scope, but not what a call does.
[[nodiscard, gnu::noinline]] CcdResult vf_ccd_unguarded(const std::array<Vec3, 4>& x_t0,
                                                        const std::array<Vec3, 4>& x_t1, const CcdOptions& options);
[[nodiscard, gnu::noinline]] CcdResult ee_ccd_unguarded(const std::array<Vec3, 4>& x_t0,
                                                        const std::array<Vec3, 4>& x_t1, const CcdOptions& options);
[[nodiscard, gnu::noinline]] CcdResult self_ccd_unguarded(const std::array<Vec3, 3>& x_t0,
                                                          const std::array<Vec3, 3>& x_t1, const CcdOptions& options);
[[nodiscard, gnu::noinline]] Proximity vf_proximity_unguarded(const std::array<Vec3, 4>& x);
[[nodiscard, gnu::noinline]] Proximity ee_proximity_unguarded(const std::array<Vec3, 4>& x);

}  // namespace selvage::detail
