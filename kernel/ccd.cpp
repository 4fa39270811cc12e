#include "kernel/ccd.h"

#include "kernel/ccd_detail.h"
#include "kernel/fp_env.h"

// The queries proper stand in ccd_query.cpp: a unit of its own, so that no floating-point operation can be moved out of
// the guard's scope.
namespace selvage {

CcdResult vf_ccd(const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1, const CcdOptions& options) {
  const FpEnvGuard guard;
  return detail::vf_ccd_unguarded(x_t0, x_t1, options);
}

CcdResult ee_ccd(const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1, const CcdOptions& options) {
  const FpEnvGuard guard;
  return detail::ee_ccd_unguarded(x_t0, x_t1, options);
}

CcdResult self_ccd(const std::array<Vec3, 3>& x_t0, const std::array<Vec3, 3>& x_t1, const CcdOptions& options) {
  const FpEnvGuard guard;
  return detail::self_ccd_unguarded(x_t0, x_t1, options);
}

}  // namespace selvage
