// The queries of ccd.h without the guard, for loops that hold one FpEnvGuard a task.
#pragma once

#include "kernel/ccd.h"
#include "kernel/proximity.h"

namespace selvage::detail {

/// As the public functions. REQUIRES the environment of FpEnvGuard.
[[nodiscard]] CcdResult vf_ccd_unguarded(const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1,
                                         const CcdOptions& options);
[[nodiscard]] CcdResult ee_ccd_unguarded(const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1,
                                         const CcdOptions& options);
[[nodiscard]] CcdResult self_ccd_unguarded(const std::array<Vec3, 3>& x_t0, const std::array<Vec3, 3>& x_t1,
                                           const CcdOptions& options);
[[nodiscard]] Proximity vf_proximity_unguarded(const std::array<Vec3, 4>& x);
[[nodiscard]] Proximity ee_proximity_unguarded(const std::array<Vec3, 4>& x);

}  // namespace selvage::detail
