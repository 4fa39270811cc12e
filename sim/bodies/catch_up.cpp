#include "sim/bodies/catch_up.h"

#include <algorithm>

#include <Eigen/Geometry>

#include "sim/base/rigid_motion.h"

namespace selvage::sim {
namespace {

double farthest(const Positions& from, const Positions& to) { return (to - from).rowwise().stableNorm().maxCoeff(); }

/// How far they may go in the step.
double allowed_m(const Positions& x, const Positions& script_t0, const Positions& script_t1, double dt_s,
                 double least_speed_m_s) {
  return farthest(script_t0, script_t1) + dt_s * std::max(farthest(x, script_t0) / kCatchUpTime_s, least_speed_m_s);
}

}  // namespace

Positions catch_up(const Positions& x, const Positions& script_t0, const Positions& script_t1, double dt_s,
                   double least_speed_m_s) {
  const double allowed = allowed_m(x, script_t0, script_t1, dt_s, least_speed_m_s), distance = farthest(x, script_t1);
  if (!(distance > allowed)) return script_t1;
  const double share = allowed / distance;
  const RigidMotion whole = best_fit_motion(x, script_t1);
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(whole.turn + Eigen::Matrix3d::Identity()));
  const Eigen::Matrix3d part = Eigen::AngleAxisd(share * turn.angle(), turn.axis()).toRotationMatrix();
  const Eigen::RowVector3d center = whole.center.transpose();
  Positions result = (x.rowwise() - center) * part.transpose();
  result.rowwise() += center + share * whole.translation.transpose();
  return result;
}

Positions catch_up_each(const Positions& x, const Positions& script_t0, const Positions& script_t1, double dt_s,
                        double least_speed_m_s) {
  Positions result = script_t1;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const double allowed = allowed_m(x.row(v), script_t0.row(v), script_t1.row(v), dt_s, least_speed_m_s);
    const Eigen::RowVector3d way = script_t1.row(v) - x.row(v);
    const double distance = way.stableNorm();
    if (distance > allowed) result.row(v) = x.row(v) + allowed / distance * way;
  }
  return result;
}

}  // namespace selvage::sim
