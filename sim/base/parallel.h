// Loops over vertices or springs in parallel where every item writes its own slot: same bits for any thread count.
#pragma once

#include <algorithm>
#include <vector>

#include <Eigen/Core>

#include "kernel/fp_env.h"
#include "kernel/own_tasks.h"

namespace selvage::sim {

/// Items are handed out in blocks of this many: a few microseconds of work on vertices or springs, and small scenes
/// stay on one thread. A multiple of any block of lanes.
inline constexpr Eigen::Index kParallelBlock = 1024;

/// Calls body(begin, end) for every block of [0, count). `body` writes only what belongs to its items.
template <class Body>
void parallel_blocks(Eigen::Index count, Body body) {
  const Eigen::Index blocks = (count + kParallelBlock - 1) / kParallelBlock;
  if (blocks == 1) {
    const FpEnvGuard guard;
    body(Eigen::Index{0}, count);
    return;
  }
  own_parallel_for(Eigen::Index{0}, blocks, [&](Eigen::Index block) {
    const FpEnvGuard guard;
    body(block * kParallelBlock, std::min(count, (block + 1) * kParallelBlock));
  });
}

/// Calls body(i) for i in [0, count). `body` writes only what belongs to i.
template <class Body>
void parallel_each(Eigen::Index count, Body body) {
  parallel_blocks(count, [&](Eigen::Index begin, Eigen::Index end) {
    for (Eigen::Index i = begin; i < end; ++i) body(i);
  });
}

/// The sum of body(begin, end) over the blocks of [0, count); `body` may write what belongs to its items. The sums of
/// blocks are added in order, so the bits depend on `count` alone. `partial` is room to work in.
template <class Sum, class Body>
Sum parallel_sum(Eigen::Index count, std::vector<Sum>& partial, Body body) {
  partial.resize(static_cast<std::size_t>((count + kParallelBlock - 1) / kParallelBlock));
  parallel_blocks(count, [&](Eigen::Index begin, Eigen::Index end) {
    partial[static_cast<std::size_t>(begin / kParallelBlock)] = body(begin, end);
  });
  Sum total{};
  for (const Sum& sum : partial) total += sum;
  return total;
}

}  // namespace selvage::sim
