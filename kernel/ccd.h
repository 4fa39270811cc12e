// Continuous collision of a vertex with a face, and of two edges, over a step (paper, section 6).
//   Trajectory  x(t) = (1 - t) x_t0 + t x_t1 over the real numbers, t in [0, 1], from stored doubles to stored doubles.
#pragma once

#include <array>

#include "kernel/input_error.h"
#include "kernel/types.h"

namespace selvage {

/// What the caller of a query chooses.
struct CcdOptions {
  double tolerance = 1e-6;            ///< closest allowed distance at t = 1, in the caller's length unit; >= 0
  std::int32_t max_intervals = 4096;  ///< bound on the time intervals one query examines (K8)
};

/// kBadTolerance, kBadOption (max_intervals < 1) or kNone. A query answers kUnresolved under options with an error.
[[nodiscard]] InputError validate(const CcdOptions& options);

/// What a query answers.
enum class CcdVerdict : std::uint8_t {
  kSeparated,  ///< PROVED: no touch for t in [0,1], and distance > tolerance at t = 1
  kCollides,   ///< the features come within gap_bound (PROVED) at some t in [0,1]: at most 2^-39 of the largest
               ///< difference of a coordinate between two of their corners at t = 0 or 1, however small they are
               ///< (kMotion); or, at t = 1, the upper bound of their distance, whose lower one tolerance reaches (kEnd)
  kUnresolved,  ///< the limit, or that of double-double arithmetic (K8), was reached: a collision at toi_lower to
                ///< whoever must be safe
};

/// What kept the query from `separated`.
enum class CcdCause : std::uint8_t {
  kNone,
  kMotion,  ///< a touch within [0,1] could not be excluded
  kEnd,     ///< PROVED free of touch over [0,1]; only the distance at t = 1 is not above tolerance
};

/// A separated answer carries no weights and no normal.
struct CcdResult {
  CcdVerdict verdict = CcdVerdict::kUnresolved;  ///< what is proved
  CcdCause cause = CcdCause::kMotion;            ///< why it is not `separated`
  double toi_lower = 0;                ///< PROVED: no touch in [0, toi_lower); 1 when separated or cause is kEnd
  double gap_bound = 0;                ///< length; PROVED for kCollides
  std::array<double, 4> weights = {};  ///< as in Proximity, at toi_lower (kMotion) or 1 (kEnd)
  Vec3 normal = Vec3::Zero();          ///< as in Proximity, at a time shortly before the touch (kMotion) or at 1; up to
                                       ///< its sign where the features touch at t = 0: no side is behind them. Zero
                                       ///< where they touch within rounding and their corners lie on a line or point
  std::int32_t intervals = 0;          ///< time intervals examined: a deterministic measure of work
};

/// x = {p, a, b, c}. Points may coincide, be collinear or stand still.
/// The verdict ignores the order and orientation of a, b, c, and scaling of all lengths by 2^k (K5).
/// REQUIRES |coordinate| <= kMaxCoordinate, all finite; anything else answers kUnresolved with toi_lower 0.
[[nodiscard]] CcdResult vf_ccd(const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1,
                               const CcdOptions& options);
/// x = {a, b, c, d}: edge (a, b) against edge (c, d). The verdict ignores order within and of the edges (K5).
[[nodiscard]] CcdResult ee_ccd(const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1,
                               const CcdOptions& options);
/// x = {p, a, b}: a vertex against the opposite edge (a, b) of its own face: the third kind of event.
[[nodiscard]] CcdResult self_ccd(const std::array<Vec3, 3>& x_t0, const std::array<Vec3, 3>& x_t1,
                                 const CcdOptions& options);
/// The query of that kind. kSelf: x = {p, a, b, anything}.
[[nodiscard]] CcdResult pair_ccd(PairKind kind, const std::array<Vec3, 4>& x_t0, const std::array<Vec3, 4>& x_t1,
                                 const CcdOptions& options);

}  // namespace selvage
