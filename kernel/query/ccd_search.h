// The search in time behind vf_ccd, ee_ccd and self_ccd, for the queries that the cull leaves.
#pragma once

#include "kernel/ccd.h"
#include "kernel/query/pair_motion.h"

namespace selvage::detail {

/// The query in canonical order. REQUIRES coordinates and tolerance within the domain. A separated answer carries no
/// weights and no normal.
[[nodiscard]] CcdResult search_in_time(PairKind kind, const PairPoints& x_t0, const PairPoints& x_t1,
                                       const CcdOptions& options);

}  // namespace selvage::detail
