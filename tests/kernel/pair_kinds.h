// The kinds of pairs that a test goes through in turn.
#pragma once

#include "kernel/types.h"

namespace selvage::testing {

inline constexpr PairKind kMeshKinds[] = {PairKind::kVf, PairKind::kEe};  ///< those that pairs of a mesh have
inline constexpr PairKind kKinds[] = {PairKind::kVf, PairKind::kEe, PairKind::kSelf};

}  // namespace selvage::testing
