#include "sim/response/travel_limit.h"

#include <cmath>

#include <Eigen/Geometry>

namespace selvage::sim {

std::int64_t limit_travel(const ScriptedGroups& groups, StepMotion& motion) {
  const auto vertex_count = static_cast<VertexId>(motion.V_t0().rows());
  Eigen::AlignedBox3d scene;
  for (VertexId v = 0; v < vertex_count; ++v) {
    scene.extend(motion.V_t0().row(v).transpose());
    if (groups.is_scripted(v)) scene.extend(motion.x().row(v).transpose());
  }
  if (scene.isEmpty()) return 0;
  const double limit = kMaxTravel * scene.sizes().stableNorm();
  if (!(limit > 0)) return 0;  // one point, or many in one: there is no size to compare with
  std::int64_t count = 0;
  for (VertexId v = 0; v < vertex_count; ++v) {
    if (groups.is_scripted(v)) continue;
    const Vec3 displacement = motion.displacement().row(v);
    const double length = displacement.stableNorm();
    if (!(length > limit)) continue;
    motion.move(v, displacement * (limit / length));
    ++count;
  }
  return count;
}

std::int64_t halve_travel(const ScriptedGroups& groups, StepMotion& motion, int times) {
  const double share = std::ldexp(1.0, -times);
  std::int64_t count = 0;
  for (VertexId v = 0; v < motion.V_t0().rows(); ++v) {
    if (groups.is_scripted(v) || !motion.moves(v)) continue;
    motion.move(v, share * motion.displacement().row(v));
    ++count;
  }
  return count;
}

}  // namespace selvage::sim
