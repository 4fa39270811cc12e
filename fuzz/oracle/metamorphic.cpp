#include "fuzz/oracle/metamorphic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace selvage::fuzz {
namespace {

/// The caller's point order[i] takes place i.
struct Relabelling {
  std::array<std::size_t, 4> order;
  bool swaps_features = false;
};

constexpr std::array<Relabelling, 5> kVfRelabellings{
    {{{0, 1, 3, 2}}, {{0, 2, 1, 3}}, {{0, 2, 3, 1}}, {{0, 3, 1, 2}}, {{0, 3, 2, 1}}}};
constexpr std::array<Relabelling, 7> kEeRelabellings{{{{1, 0, 2, 3}},
                                                      {{0, 1, 3, 2}},
                                                      {{1, 0, 3, 2}},
                                                      {{2, 3, 0, 1}, true},
                                                      {{3, 2, 0, 1}, true},
                                                      {{2, 3, 1, 0}, true},
                                                      {{3, 2, 1, 0}, true}}};
constexpr std::array<Relabelling, 1> kSelfRelabellings{{{{0, 2, 1, 3}}}};

std::span<const Relabelling> relabellings(PairKind kind) {
  switch (kind) {
    case PairKind::kVf:
      return kVfRelabellings;
    case PairKind::kEe:
      return kEeRelabellings;
    case PairKind::kSelf:
      break;
  }
  return kSelfRelabellings;
}

MotionQuery relabel(const MotionQuery& query, const Relabelling& relabelling) {
  MotionQuery other = query;
  for (std::size_t i = 0; i < 4; ++i) {
    other.x_t0[i] = query.x_t0[relabelling.order[i]];
    other.x_t1[i] = query.x_t1[relabelling.order[i]];
  }
  return other;
}

/// Points that coincide at both ends are one point to the kernel: it may give either of them the weight.
bool has_twins(const MotionQuery& query) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(point_count(query.kind)); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (query.x_t0[i] == query.x_t0[j] && query.x_t1[i] == query.x_t1[j]) return true;
    }
  }
  return false;
}

/// Everything but weights and normal. The comparison of doubles takes 0 and -0 as equal, and NaN as different.
bool same_core(const CcdResult& a, const CcdResult& b) {
  return a.verdict == b.verdict && a.cause == b.cause && a.toi_lower == b.toi_lower && a.intervals == b.intervals;
}

}  // namespace

bool answers_follow_relabelling(const MotionQuery& query, const CcdResult& answer, CcdKernel kernel) {
  // Where coordinates tie, the search for the closest point may pick either of several closest points, but the labels
  // cannot decide which: the answer's direction is still the same up to the swap of the features.
  const bool weights_are_unique = !has_twins(query);
  for (const Relabelling& relabelling : relabellings(query.kind)) {
    const CcdResult other = kernel(relabel(query, relabelling));
    if (!same_core(answer, other) || answer.gap_bound != other.gap_bound) return false;
    const Vec3 normal = relabelling.swaps_features ? Vec3(-other.normal) : other.normal;
    if (answer.normal != normal && weights_are_unique) return false;
    for (std::size_t i = 0; i < 4 && weights_are_unique; ++i) {
      if (other.weights[i] != answer.weights[relabelling.order[i]]) return false;
    }
  }
  return true;
}

std::optional<MotionQuery> scaled_query(const MotionQuery& query, int exponent) {
  MotionQuery scaled = query;
  bool exact = true;
  const auto scale = [&](double& x) {
    const double original = x;
    x = std::ldexp(x, exponent);
    exact = exact && std::ldexp(x, -exponent) == original && std::abs(x) <= kMaxCoordinate;
  };
  for (auto* x : {&scaled.x_t0, &scaled.x_t1}) {
    for (auto& point : *x) {
      for (double& coordinate : point) scale(coordinate);
    }
  }
  scale(scaled.options.tolerance);
  return exact ? std::optional(scaled) : std::nullopt;
}

bool answer_follows_scale(const CcdResult& answer, int exponent, const CcdResult& scaled) {
  if (!same_core(answer, scaled) || answer.weights != scaled.weights || answer.normal != scaled.normal) return false;
  // A bound that is subnormal at one of the two scales has been rounded up there: only whether it is zero can be told.
  constexpr double kNormal = std::numeric_limits<double>::min();
  const bool rounded = std::min(answer.gap_bound, scaled.gap_bound) < kNormal;
  return rounded ? (answer.gap_bound == 0) == (scaled.gap_bound == 0)
                 : std::ldexp(answer.gap_bound, exponent) == scaled.gap_bound;
}

}  // namespace selvage::fuzz
