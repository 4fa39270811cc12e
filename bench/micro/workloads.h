// Work of a fixed amount, for clocks (micro.cpp) and for counts of instructions (instructions.cpp).
#pragma once

#include <cstdint>
#include <vector>

#include "bench/mesh_motion.h"
#include "bench/query_methods.h"

namespace selvage::bench {

/// The motion of a crumpled sheet and its candidates, as queries too.
struct SheetWork {
  MeshMotion motion;
  Candidates candidates;
  std::vector<MethodQuery> queries;
};
[[nodiscard]] SheetWork sheet_work(int side);

// Each returns a number that depends on all of its work, so that none of it can be left out.

/// One query after another (ccd.h).
[[nodiscard]] std::int64_t ask_single(const SheetWork& work);
/// All candidates in batches (ccd_batch.h).
[[nodiscard]] std::int64_t ask_in_batches(const SheetWork& work);
/// A hierarchy refitted and asked for its candidates (box_hierarchy.h).
[[nodiscard]] std::int64_t find_candidates(const SheetWork& work);
/// The exact checker's bare decisions (exact_motion.h).
[[nodiscard]] std::int64_t decide_exactly(const SheetWork& work);

}  // namespace selvage::bench
