// Promise K5: what an answer must do when the query is relabelled or scaled. Bit for bit; no oracle needed.
#pragma once

#include <optional>

#include "fuzz/base/motion_query.h"

namespace selvage::fuzz {

/// Asks `kernel` again for every relabelling of the features (vf: 6 orders of the corners; ee: 8, the edges swapped
/// included; self: 2). The answers must have equal verdicts, times, bounds and work; weights must move with their
/// points, and the normal may only change sign, where the features are swapped.
[[nodiscard]] bool answers_follow_relabelling(const MotionQuery& query, const CcdResult& answer, CcdKernel kernel);

/// All lengths times 2^exponent, tolerance included; nothing where that is inexact or leaves the domain.
[[nodiscard]] std::optional<MotionQuery> scaled_query(const MotionQuery& query, int exponent);
/// Whether `scaled` is `answer` with gap_bound times 2^exponent and nothing else changed.
[[nodiscard]] bool answer_follows_scale(const CcdResult& answer, int exponent, const CcdResult& scaled);

}  // namespace selvage::fuzz
