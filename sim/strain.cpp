#include "sim/strain.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "sim/parallel.h"

namespace selvage::sim {
namespace {

struct SpringMotion {
  Eigen::RowVector3d direction;  ///< unit, from a to b at the start of the step
  double length_t0 = 0;
  double along = 0;           ///< component along `direction` of the vector from a to b at the end of the step
  double across_squared = 0;  ///< and its squared component across
  [[nodiscard]] double length_t1() const { return std::sqrt(along * along + across_squared); }
};

SpringMotion motion_of(const Spring& spring, const PositionsRef& x, const Positions& v, double dt_s) {
  SpringMotion motion;
  const Eigen::RowVector3d d = x.row(spring.b) - x.row(spring.a);
  motion.length_t0 = d.norm();
  motion.direction = motion.length_t0 > 0 ? Eigen::RowVector3d(d / motion.length_t0) : Eigen::RowVector3d::Zero();
  const Eigen::RowVector3d end = d + dt_s * (v.row(spring.b) - v.row(spring.a));
  motion.along = end.dot(motion.direction);
  motion.across_squared = (end - motion.along * motion.direction).squaredNorm();
  return motion;
}

// The change of `along` that brings the length into [shortest, longest]; where the motion across is too long for that,
// the change that leaves the least length. Never reverses the approach: it stops at no relative motion along the
// spring.
double correction(const SpringMotion& motion, double shortest, double longest) {
  const double length_t1 = motion.length_t1();
  const double target = length_t1 > longest ? longest : (length_t1 < shortest ? shortest : length_t1);
  if (target == length_t1) return 0;
  const double along = std::sqrt(std::max(0.0, target * target - motion.across_squared));
  const double stop = motion.length_t0 - motion.along;  // no change of the length along the direction
  const double wanted = along - motion.along;
  return stop < 0 ? std::clamp(wanted, stop, 0.0) : std::clamp(wanted, 0.0, stop);
}

bool limited(const Spring& spring, std::span<const double> inverse_mass) {
  return spring.kind != SpringKind::kBending &&
         inverse_mass[static_cast<std::size_t>(spring.a)] + inverse_mass[static_cast<std::size_t>(spring.b)] > 0;
}

}  // namespace

std::int64_t limit_strain(const SpringSystem& springs, std::span<const double> inverse_mass, const PositionsRef& x,
                          double dt_s, const StrainLimits& limits, Positions& v) {
  if (limits.strain == 0) return 0;
  std::int64_t impulses = 0;
  Positions change(static_cast<Eigen::Index>(springs.springs().size()), 3);  // of v_b - v_a
  std::vector<std::uint8_t> active(springs.springs().size());
  std::vector<std::int32_t> active_at(static_cast<std::size_t>(springs.vertex_count()));
  for (std::int32_t iteration = 0; iteration < limits.strain_iterations; ++iteration) {
    parallel_each(change.rows(), [&](Eigen::Index s) {
      const Spring& spring = springs.springs()[static_cast<std::size_t>(s)];
      active[static_cast<std::size_t>(s)] = 0;
      if (!limited(spring, inverse_mass)) return;
      const SpringMotion motion = motion_of(spring, x, v, dt_s);
      const double longest = std::max((1 + limits.strain) * spring.rest_length_m, motion.length_t0);
      const double shortest = std::min((1 - limits.strain) * spring.rest_length_m, motion.length_t0);
      const double along = correction(motion, shortest, longest);
      if (along == 0) return;
      active[static_cast<std::size_t>(s)] = 1;
      change.row(s) = (along / dt_s) * motion.direction;
    });
    std::fill(active_at.begin(), active_at.end(), 0);
    std::int64_t found = 0;
    for (std::size_t s = 0; s < active.size(); ++s) {
      if (active[s] == 0) continue;
      ++found;
      ++active_at[static_cast<std::size_t>(springs.springs()[s].a)];
      ++active_at[static_cast<std::size_t>(springs.springs()[s].b)];
    }
    if (found == 0) break;
    impulses += found;
    parallel_each(springs.vertex_count(), [&](Eigen::Index i) {
      const double w = inverse_mass[static_cast<std::size_t>(i)];
      if (w == 0) return;
      springs.for_each_at(static_cast<VertexId>(i), [&](std::uint32_t s, double sign) {
        if (active[s] == 0) return;
        const Spring& spring = springs.springs()[s];
        const auto a = static_cast<std::size_t>(spring.a), b = static_cast<std::size_t>(spring.b);
        const double share = 1.0 / std::max(active_at[a], active_at[b]);
        v.row(i) -= (sign * share * w / (inverse_mass[a] + inverse_mass[b])) * change.row(s);
      });
    });
  }
  return impulses;
}

std::int64_t limit_strain_rate(const SpringSystem& springs, std::span<const double> inverse_mass, const PositionsRef& x,
                               double dt_s, const StrainLimits& limits, Positions& v) {
  if (limits.strain_rate == 0) return 0;
  std::int64_t impulses = 0;
  for (std::int32_t iteration = 0; iteration < limits.strain_rate_iterations; ++iteration) {
    std::int64_t found = 0;
    for (const Spring& spring : springs.springs()) {
      if (!limited(spring, inverse_mass)) continue;
      const SpringMotion motion = motion_of(spring, x, v, dt_s);
      const double along =
          correction(motion, (1 - limits.strain_rate) * motion.length_t0, (1 + limits.strain_rate) * motion.length_t0);
      if (along == 0) continue;
      ++found;
      const double w_a = inverse_mass[static_cast<std::size_t>(spring.a)];
      const double w_b = inverse_mass[static_cast<std::size_t>(spring.b)];
      const Eigen::RowVector3d impulse = (along / dt_s / (w_a + w_b)) * motion.direction;
      v.row(spring.a) -= w_a * impulse;
      v.row(spring.b) += w_b * impulse;
    }
    impulses += found;
    if (found == 0) break;
  }
  return impulses;
}

}  // namespace selvage::sim
