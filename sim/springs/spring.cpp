#include "sim/springs/spring.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "kernel/assert.h"

namespace selvage::sim {
namespace {

constexpr std::uint32_t kSpringMask = 0x7fffffff;

}  // namespace

SpringSystem::SpringSystem(std::vector<Spring> springs, std::int32_t vertex_count)
    : springs_(std::move(springs)), begin_(static_cast<std::size_t>(vertex_count) + 1) {
  SELVAGE_ASSERT(springs_.size() <= kSpringMask);
  for (const Spring& spring : springs_) {
    SELVAGE_ASSERT(spring.a != spring.b && std::min(spring.a, spring.b) >= 0 &&
                   std::max(spring.a, spring.b) < vertex_count);
    ++begin_[static_cast<std::size_t>(spring.a) + 1];
    ++begin_[static_cast<std::size_t>(spring.b) + 1];
  }
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  ends_.resize(2 * springs_.size());
  std::vector<std::size_t> next(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t s = 0; s < springs_.size(); ++s) {
    ends_[next[static_cast<std::size_t>(springs_[s].a)]++] = {springs_[s].b, s & kSpringMask, 0};
    ends_[next[static_cast<std::size_t>(springs_[s].b)]++] = {springs_[s].a, s & kSpringMask, 1};
  }
}

double stable_step_s(const SpringSystem& springs, std::span<const double> inverse_mass,
                     const StabilizerSystem& stabilizers) {
  double omega_squared_upper = 0;
  for (VertexId i = 0; i < springs.vertex_count(); ++i) {
    double stiffness = 0;
    for (const SpringSystem::End& end : springs.ends_at(i)) stiffness += springs.springs()[end.spring].stiffness_n_m;
    omega_squared_upper = std::max(
        omega_squared_upper, inverse_mass[static_cast<std::size_t>(i)] * (2 * stiffness + stabilizers.row_sum_n_m(i)));
  }
  return omega_squared_upper > 0 ? 2 / std::sqrt(omega_squared_upper) : std::numeric_limits<double>::infinity();
}

}  // namespace selvage::sim
