// One collision query as the fuzzer, the kernel, the exact checker and the case files see it.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "kernel/ccd.h"
#include "verify/decision/exact_motion.h"

namespace selvage::fuzz {

struct MotionQuery {
  PairKind kind = PairKind::kVf;
  /// vf: p, a, b, c. ee: a, b, c, d. self: p, a, b, and the last point repeats p and means nothing.
  std::array<Vec3, 4> x_t0{}, x_t1{};
  CcdOptions options{.tolerance = 0};
};

[[nodiscard]] constexpr int point_count(PairKind kind) { return kind == PairKind::kSelf ? 3 : 4; }
[[nodiscard]] std::string_view name_of(PairKind kind);

inline constexpr std::array<PairKind, 3> kPairKinds{PairKind::kVf, PairKind::kEe, PairKind::kSelf};

/// A collision kernel under test: ours, a baseline, one with a planted defect, or a user's own.
using CcdKernel = CcdResult (*)(const MotionQuery& query);

/// pair_ccd().
[[nodiscard]] CcdResult selvage_kernel(const MotionQuery& query);

/// Nothing but doubles crosses into the checker.
[[nodiscard]] std::array<verify::Point, 4> raw(const std::array<Vec3, 4>& x);
[[nodiscard]] verify::MotionAnswer exact_motion(const MotionQuery& query, verify::Detail detail);
/// The decision, and the sign of (first touch - t).
[[nodiscard]] verify::MotionAgainst motion_against(const MotionQuery& query, double t);
/// Whether the features are within d (closed) at t, exactly. At the ends of the step filters answer most queries.
[[nodiscard]] bool within_at(const MotionQuery& query, double t, double d);

/// Largest |coordinate| at either end.
[[nodiscard]] double max_coordinate(const MotionQuery& query);
/// Whether the kernel promises anything about it: kernel/types.h.
[[nodiscard]] bool is_in_domain(const MotionQuery& query);
/// Largest side of the box of all points at both ends, rounded: a length that describes the query.
[[nodiscard]] double extent(const MotionQuery& query);

/// How far from a touch a kernel that is not ours calls a collision, as it says itself.
struct DeclaredGap {
  double tolerance = 0, relative_tolerance = 0;
  [[nodiscard]] double of(const MotionQuery& query) const { return tolerance + relative_tolerance * extent(query); }
};

}  // namespace selvage::fuzz
