#include "sim/strain.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

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

SpringMotion motion_of(const Spring& spring, std::size_t s, const Positions& x, const SpringStretch& stretch,
                       const Positions& v, double dt_s) {
  SpringMotion motion;
  motion.length_t0 = stretch.length[s];
  motion.direction = stretch.direction.row(static_cast<Eigen::Index>(s));
  const Eigen::RowVector3d end = x.row(spring.b) - x.row(spring.a) + dt_s * (v.row(spring.b) - v.row(spring.a));
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

double square(double value) { return value * value; }

/// The number of the next flagged item from `begin` on, or flags.size().
std::size_t next_flagged(const std::vector<std::uint8_t>& flags, std::size_t begin) {
  const void* found = begin < flags.size() ? std::memchr(&flags[begin], 1, flags.size() - begin) : nullptr;
  return found == nullptr ? flags.size()
                          : static_cast<std::size_t>(static_cast<const std::uint8_t*>(found) - flags.data());
}

}  // namespace

StrainLimiter::StrainLimiter(const SpringSystem& springs, const StrainLimits& limits)
    : springs_(springs),
      limits_(limits),
      is_suspect_(springs.springs().size()),
      active_count_(static_cast<std::size_t>(springs.vertex_count())) {
  for (std::uint32_t s = 0; s < springs.springs().size(); ++s) {
    const Spring& spring = springs.springs()[s];
    if (spring.kind == SpringKind::kBending) continue;
    limited_.push_back({spring.a, spring.b, s, square((1 - limits.strain) * spring.rest_length_m),
                        square((1 + limits.strain) * spring.rest_length_m)});
  }
}

template <class Bounds>
void StrainLimiter::find_suspects(const Positions& x, double dt_s, const Positions& v, Bounds bounds) {
  end_.resize(x.rows(), 3);
  parallel_each(x.rows(), [&](Eigen::Index i) { end_.row(i) = x.row(i) + dt_s * v.row(i); });
  parallel_each(static_cast<Eigen::Index>(limited_.size()), [&](Eigen::Index i) {
    const Limited& spring = limited_[static_cast<std::size_t>(i)];
    const double squared = (end_.row(spring.b) - end_.row(spring.a)).squaredNorm();
    const auto [shortest, longest] = bounds(spring);
    is_suspect_[spring.spring] = !(squared >= shortest && squared <= longest) ? 1 : 0;
  });
}

std::int64_t StrainLimiter::limit_strain(std::span<const double> inverse_mass, const Positions& x,
                                         const SpringStretch& stretch, double dt_s, Positions& v) {
  if (limits_.strain == 0) return 0;
  std::int64_t impulses = 0;
  for (std::int32_t iteration = 0; iteration < limits_.strain_iterations; ++iteration) {
    find_suspects(x, dt_s, v, [](const Limited& s) { return std::pair(s.shortest_squared, s.longest_squared); });
    active_.clear();
    change_.clear();
    for (std::size_t s = next_flagged(is_suspect_, 0); s < is_suspect_.size(); s = next_flagged(is_suspect_, s + 1)) {
      const Spring& spring = springs_.springs()[s];
      const auto a = static_cast<std::size_t>(spring.a), b = static_cast<std::size_t>(spring.b);
      if (!(inverse_mass[a] + inverse_mass[b] > 0)) continue;
      const SpringMotion motion = motion_of(spring, s, x, stretch, v, dt_s);
      const double longest = std::max((1 + limits_.strain) * spring.rest_length_m, motion.length_t0);
      const double shortest = std::min((1 - limits_.strain) * spring.rest_length_m, motion.length_t0);
      const double along = correction(motion, shortest, longest);
      if (along == 0) continue;
      active_.push_back(s);
      change_.push_back(along / dt_s);
      ++active_count_[a];
      ++active_count_[b];
    }
    if (active_.empty()) break;
    impulses += static_cast<std::int64_t>(active_.size());
    for (std::size_t k = 0; k < active_.size(); ++k) {
      const Spring& spring = springs_.springs()[active_[k]];
      const auto a = static_cast<std::size_t>(spring.a), b = static_cast<std::size_t>(spring.b);
      const double share = 1.0 / std::max(active_count_[a], active_count_[b]);
      const Eigen::RowVector3d impulse = (share * change_[k] / (inverse_mass[a] + inverse_mass[b])) *
                                         stretch.direction.row(static_cast<Eigen::Index>(active_[k]));
      v.row(spring.a) -= inverse_mass[a] * impulse;
      v.row(spring.b) += inverse_mass[b] * impulse;
    }
    for (const std::size_t s : active_) {
      active_count_[static_cast<std::size_t>(springs_.springs()[s].a)] = 0;
      active_count_[static_cast<std::size_t>(springs_.springs()[s].b)] = 0;
    }
  }
  return impulses;
}

void StrainLimiter::suspect_springs_at(VertexId vertex) {
  for (const SpringSystem::End& end : springs_.ends_at(vertex)) {
    if (springs_.springs()[end.spring].kind != SpringKind::kBending) is_suspect_[end.spring] = 1;
  }
}

bool StrainLimiter::relax_rate(std::size_t s, std::span<const double> inverse_mass, const Positions& x,
                               const SpringStretch& stretch, double dt_s, Positions& v) {
  const Spring& spring = springs_.springs()[s];
  const double w_a = inverse_mass[static_cast<std::size_t>(spring.a)];
  const double w_b = inverse_mass[static_cast<std::size_t>(spring.b)];
  if (!(w_a + w_b > 0)) return false;
  const SpringMotion motion = motion_of(spring, s, x, stretch, v, dt_s);
  const double along =
      correction(motion, (1 - limits_.strain_rate) * motion.length_t0, (1 + limits_.strain_rate) * motion.length_t0);
  if (along == 0) return false;
  const Eigen::RowVector3d impulse = (along / dt_s / (w_a + w_b)) * motion.direction;
  v.row(spring.a) -= w_a * impulse;
  v.row(spring.b) += w_b * impulse;
  return true;
}

// A spring is visited if it was over its limit at first, or if an end changed since it was visited last. Flags ahead of
// the sweep are met by it, flags behind it by the next: the same impulses as if every sweep visited every spring.
std::int64_t StrainLimiter::limit_strain_rate(std::span<const double> inverse_mass, const Positions& x,
                                              const SpringStretch& stretch, double dt_s, Positions& v) {
  if (limits_.strain_rate == 0) return 0;
  std::int64_t impulses = 0;
  const double shortest = square(1 - limits_.strain_rate), longest = square(1 + limits_.strain_rate);
  find_suspects(x, dt_s, v, [&](const Limited& s) {
    const double squared = square(stretch.length[s.spring]);
    return std::pair(shortest * squared, longest * squared);
  });
  for (std::int32_t iteration = 0; iteration < limits_.strain_rate_iterations; ++iteration) {
    std::int64_t found = 0;
    for (std::size_t s = next_flagged(is_suspect_, 0); s < is_suspect_.size(); s = next_flagged(is_suspect_, s + 1)) {
      is_suspect_[s] = 0;
      if (!relax_rate(s, inverse_mass, x, stretch, dt_s, v)) continue;
      ++found;
      suspect_springs_at(springs_.springs()[s].a);
      suspect_springs_at(springs_.springs()[s].b);
    }
    impulses += found;
    if (found == 0) break;
  }
  return impulses;
}

}  // namespace selvage::sim
