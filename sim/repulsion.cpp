#include "sim/repulsion.h"

#include <algorithm>

namespace selvage::sim {

Repulsion repulsion(double distance, double displacement, double inverse_mass_kg, const CollisionOptions& options,
                    double dt_s) {
  Repulsion result;
  result.inelastic = std::max(-displacement, 0.0);
  const double overlap = options.thickness_m - distance;
  if (!(options.repulsion_stiffness_n_m > 0) || !(overlap > 0)) return result;
  const double limit = options.overlap_fraction * overlap - (displacement + result.inelastic);
  if (!(limit > 0)) return result;
  // v_N dt = dt * (k d dt) * K. Not `min`: an overflow times an underflow is NaN and must end at the limit too.
  const double spring = dt_s * dt_s * options.repulsion_stiffness_n_m * overlap * inverse_mass_kg;
  result.spring = spring < limit ? spring : limit;
  return result;
}

}  // namespace selvage::sim
