#include "kernel/ccd.h"

#include <limits>

#include "kernel/fp_env.h"
#include "kernel/query/ccd_detail.h"

namespace selvage {

InputError validate(const CcdOptions& options) {
  const bool is_length = options.tolerance >= 0 && options.tolerance < std::numeric_limits<double>::infinity();
  if (!is_length) return InputError::kBadTolerance;
  return options.max_intervals >= 1 ? InputError::kNone : InputError::kBadOption;
}

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

CcdResult pair_ccd(PairKind kind, const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1,
                   const CcdOptions& options) {
  if (kind == PairKind::kVf) return vf_ccd(x_t0, x_t1, options);
  if (kind == PairKind::kEe) return ee_ccd(x_t0, x_t1, options);
  return self_ccd({x_t0[0], x_t0[1], x_t0[2]}, {x_t1[0], x_t1[1], x_t1[2]}, options);
}

}  // namespace selvage
