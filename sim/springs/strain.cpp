#include "sim/springs/strain.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "sim/base/disjoint_sets.h"
#include "sim/base/parallel.h"
#include "sim/springs/scripted_drive.h"

namespace selvage::sim {
namespace {

struct SpringMotion {
  Eigen::RowVector3d direction;  ///< unit, from a to b at the start of the step
  double length_t0 = 0;
  double along = 0;           ///< component along `direction` of the vector from a to b at the end of the step
  double across_squared = 0;  ///< and its squared component across
  [[nodiscard]] double length_t1() const { return std::sqrt(along * along + across_squared); }
};

SpringMotion motion_of(const Spring& spring, const LimitedMotion& step) {
  const Eigen::RowVector3d start = step.x_t0.row(spring.b) - step.x_t0.row(spring.a);
  const Eigen::RowVector3d end = step.x_t1.row(spring.b) - step.x_t1.row(spring.a);
  SpringMotion motion;
  motion.length_t0 = start.norm();
  motion.direction = (motion.length_t0 > 0 ? 1 / motion.length_t0 : 0.0) * start;
  motion.along = end.dot(motion.direction);
  motion.across_squared = (end - motion.along * motion.direction).squaredNorm();
  return motion;
}

/// How much farther than the longest it goes along the spring; no more than it moves.
double too_long(const SpringMotion& motion, double longest) {
  const double along = std::sqrt(std::max(0.0, longest * longest - motion.across_squared));
  return motion.along - std::max(motion.length_t0, along);
}

double too_short(const SpringMotion& motion, double shortest) {
  const double along = std::sqrt(std::max(0.0, shortest * shortest - motion.across_squared));
  return std::min(motion.length_t0, along) - motion.along;
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
      check_(springs),
      is_suspect_(springs.springs().size()),
      projection_(springs.vertex_count()),
      borne_n_s_(springs.springs().size()) {
  DisjointSets<VertexId> joined(springs.vertex_count());
  for (const Spring& spring : springs.springs()) joined.join(spring.a, spring.b);
  for (VertexId v = 0; v < springs.vertex_count(); ++v) {  // a root is the smallest of its set
    const VertexId root = joined.root(v);
    set_of_.push_back(root == v ? sets_.size() : set_of_[static_cast<std::size_t>(root)]);
    if (root == v) sets_.emplace_back();
  }
}

void StrainLimiter::apply(const Spring& spring, const Eigen::RowVector3d& impulse, std::span<const double> inverse_mass,
                          const LimitedMotion& motion) const {
  motion.v.row(spring.a) -= inverse_mass[static_cast<std::size_t>(spring.a)] * impulse;
  motion.v.row(spring.b) += inverse_mass[static_cast<std::size_t>(spring.b)] * impulse;
  for (const VertexId i : {spring.a, spring.b}) {
    motion.x_t1.row(i) = motion.x_t0.row(i) + motion.dt_s * motion.v.row(i);
  }
}

void StrainLimiter::forget() {
  for (const std::size_t spring : bearing_) borne_n_s_[spring] = 0;
  bearing_.clear();
}

std::optional<StrainLimiter::Look> StrainLimiter::look_at(std::size_t number, std::span<const double> inverse_mass,
                                                          const LimitedMotion& motion) const {
  const Spring& spring = springs_.springs()[number];
  const double w_a = inverse_mass[static_cast<std::size_t>(spring.a)];
  const double w_b = inverse_mass[static_cast<std::size_t>(spring.b)];
  if (!(w_a + w_b > 0)) return std::nullopt;
  const SpringMotion spring_motion = motion_of(spring, motion);
  const double longest = std::max((1 + limits_.strain) * spring.rest_length_m, spring_motion.length_t0);
  const double shortest = std::min((1 - limits_.strain) * spring.rest_length_m, spring_motion.length_t0);
  const double borne = borne_n_s_[number];
  const bool is_long = borne == 0 ? spring_motion.length_t1() > longest : borne > 0;
  const double too_far = is_long ? too_long(spring_motion, longest) : too_short(spring_motion, shortest);
  if (borne == 0 && !(too_far > 0)) return std::nullopt;
  const Vec3 towards_b = spring_motion.direction.transpose();
  const Vec3 direction = is_long ? towards_b : Vec3(-towards_b);
  return Look{{spring.a, spring.b, w_a, w_b, direction, too_far / motion.dt_s, std::abs(borne)}, {number, is_long}};
}

void StrainLimiter::find_pairs(std::span<const double> inverse_mass, const LimitedMotion& motion) {
  for (const std::size_t s : bearing_) is_suspect_[s] = 1;
  suspects_.clear();
  for (std::size_t s = next_flagged(is_suspect_, 0); s < is_suspect_.size(); s = next_flagged(is_suspect_, s + 1)) {
    suspects_.push_back(s);
  }
  looks_.resize(suspects_.size());
  parallel_each(std::ssize(suspects_), [&](Eigen::Index i) {
    const auto at = static_cast<std::size_t>(i);
    looks_[at] = look_at(suspects_[at], inverse_mass, motion);
  });
  for (Set& set : sets_) {
    set.pairs.clear();
    set.limited.clear();
  }
  for (const auto& look : looks_) {
    if (!look) continue;
    Set& set = sets_[set_of_[static_cast<std::size_t>(look->pair.a)]];
    set.pairs.push_back(look->pair);
    set.limited.push_back(look->limited);
  }
}

std::int64_t StrainLimiter::limit(Set& set, ImpulseProjection::Start start, std::span<const double> inverse_mass,
                                  const LimitedMotion& motion) {
  projection_.begin_from(set.first_m_s);
  projection_.solve(set.pairs, start, limits_.strain_iterations);
  set.first_m_s = projection_.first_m_s();
  limit_drive(motion.v, set.pairs);
  std::int64_t impulses = 0;
  for (std::size_t i = 0; i < set.pairs.size(); ++i) {
    const BoundedPair& pair = set.pairs[i];
    if (pair.change_n_s == 0) continue;
    const Spring& spring = springs_.springs()[set.limited[i].spring];
    apply(spring, -pair.change_n_s * pair.direction.transpose(), inverse_mass, motion);
    ++impulses;
  }
  return impulses;
}

std::int64_t StrainLimiter::limit_strain(std::span<const double> inverse_mass, const LimitedMotion& motion) {
  if (limits_.strain == 0) return 0;
  std::int64_t impulses = 0;
  for (const auto start : {ImpulseProjection::Start::kGuess, ImpulseProjection::Start::kActing}) {
    check_.find_outside(motion.x_t0, motion.x_t1, LengthCheck::Reference::kRestLength, limits_.strain, is_suspect_);
    const bool is_first = start == ImpulseProjection::Start::kGuess;
    const auto bears_nothing = [](const BoundedPair& pair) { return pair.impulse_n_s == 0; };
    find_pairs(inverse_mass, motion);
    forget();
    for (Set& set : sets_) {
      const bool finds_others = std::ranges::any_of(set.pairs, bears_nothing);
      if (!set.pairs.empty() && (is_first || finds_others)) impulses += limit(set, start, inverse_mass, motion);
      for (std::size_t i = 0; i < set.pairs.size(); ++i) {
        const auto [spring, is_long] = set.limited[i];
        const double impulse_n_s = set.pairs[i].impulse_n_s;
        if (!(impulse_n_s > 0)) continue;
        bearing_.push_back(spring);
        borne_n_s_[spring] = is_long ? impulse_n_s : -impulse_n_s;
      }
    }
  }
  return impulses;
}

void StrainLimiter::suspect_springs_at(VertexId vertex) {
  for (const SpringSystem::End& end : springs_.ends_at(vertex)) {
    if (springs_.springs()[end.spring].kind != SpringKind::kBending) is_suspect_[end.spring] = 1;
  }
}

bool StrainLimiter::relax_rate(const Spring& spring, std::span<const double> inverse_mass,
                               const LimitedMotion& motion) const {
  const double inverse_masses =
      inverse_mass[static_cast<std::size_t>(spring.a)] + inverse_mass[static_cast<std::size_t>(spring.b)];
  if (!(inverse_masses > 0)) return false;
  const SpringMotion spring_motion = motion_of(spring, motion);
  const double shortest = std::min((1 - limits_.strain_rate) * spring_motion.length_t0, spring.rest_length_m);
  const double longest = std::max((1 + limits_.strain_rate) * spring_motion.length_t0, spring.rest_length_m);
  const double along = correction(spring_motion, shortest, longest);
  if (along == 0) return false;
  apply(spring, (along / motion.dt_s / inverse_masses) * spring_motion.direction, inverse_mass, motion);
  return true;
}

// A spring is visited if it was over its limit at first, or if an end changed since it was visited last. Flags ahead of
// the sweep are met by it, flags behind it by the next: the same impulses as if every sweep visited every spring.
std::int64_t StrainLimiter::limit_strain_rate(std::span<const double> inverse_mass, const LimitedMotion& motion) {
  if (limits_.strain_rate == 0) return 0;
  std::int64_t impulses = 0;
  check_.find_outside(motion.x_t0, motion.x_t1, LengthCheck::Reference::kLengthNow, limits_.strain_rate, is_suspect_);
  for (std::int32_t iteration = 0; iteration < limits_.strain_rate_iterations; ++iteration) {
    std::int64_t found = 0;
    for (std::size_t s = next_flagged(is_suspect_, 0); s < is_suspect_.size(); s = next_flagged(is_suspect_, s + 1)) {
      is_suspect_[s] = 0;
      const Spring& spring = springs_.springs()[s];
      if (!relax_rate(spring, inverse_mass, motion)) continue;
      ++found;
      suspect_springs_at(spring.a);
      suspect_springs_at(spring.b);
    }
    impulses += found;
    if (found == 0) break;
  }
  return impulses;
}

}  // namespace selvage::sim
