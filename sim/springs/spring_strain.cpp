#include "sim/springs/spring_strain.h"

#include <algorithm>
#include <cmath>

#include "sim/base/parallel.h"

namespace selvage::sim {
namespace {

// The dynamics itself ends a little beyond the limit, which its iterations only approach
// (docs/measurements/numerics.md).
constexpr double kLimitsBorne = 1.5;
// Where a body pulls at cloth, all of it is strained for a while, and shorter steps do not help: at most 0.27 in
// sim/scenes/curtain.toml at full quality, 2.3 s, in steps of 1/1920 s, 4,000 springs beyond 0.15.
constexpr double kLimitsBorneInAll = 3;
// Of the limit, in a step. With a hundredth, steps were halved for cloth at rest over the edge of a box as well, whose
// springs are pressed there for good; with three tenths, springs of a sheet that falls on its edge lost a third of
// their length (tests/sim/step_test.cpp).
constexpr double kGrowth = 0.2;

double strain(const Spring& spring, const PositionsRef& x) { return std::abs(elongation(spring, x)); }

/// For parallel_sum(): the "sum" of two is the larger, or the first.
struct Largest : Strained {
  Largest& operator+=(const Largest& other) {
    if (other.strain > strain) *this = other;
    return *this;
  }
};

/// By what is asked of structural and shear springs.
Strained largest(const SpringSystem& springs, const PositionsRef& x, double (*of)(const Spring&, const PositionsRef&)) {
  const auto& all = springs.springs();
  std::vector<Largest> partial;
  return parallel_sum(std::ssize(all), partial, [&](Eigen::Index begin, Eigen::Index end) {
    Largest most;
    for (Eigen::Index i = begin; i < end; ++i) {
      const Spring& spring = all[static_cast<std::size_t>(i)];
      if (spring.kind != SpringKind::kBending) most += Largest{{of(spring, x), {spring.a, spring.b}}};
    }
    return most;
  });
}

}  // namespace

std::int64_t springs_overstrained(const SpringSystem& springs, double strain_limit, const StrainedMotion& motion) {
  if (!(strain_limit > 0)) return 0;
  const auto& all = springs.springs();
  std::vector<std::int64_t> partial;
  return parallel_sum(std::ssize(all), partial, [&](Eigen::Index begin, Eigen::Index end) {
    std::int64_t count = 0;
    for (Eigen::Index i = begin; i < end; ++i) {
      const Spring& spring = all[static_cast<std::size_t>(i)];
      if (spring.kind == SpringKind::kBending) continue;
      const double after = strain(spring, motion.x_t1);
      if (!(after > kLimitsBorne * strain_limit)) continue;
      double before = strain(spring, motion.x_t0);
      if (!(after > kLimitsBorneInAll * strain_limit)) before = std::max(before, strain(spring, motion.candidate));
      count += after > before + kGrowth * strain_limit;
    }
    return count;
  });
}

Strained most_strained(const SpringSystem& springs, const PositionsRef& x) { return largest(springs, x, strain); }

double largest_elongation(const SpringSystem& springs, const PositionsRef& x) {
  return largest(springs, x, elongation).strain;
}

}  // namespace selvage::sim
