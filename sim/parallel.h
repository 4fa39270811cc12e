// Loops over vertices or springs in parallel where every item writes its own slot: same bits for any thread count.
#pragma once

#include <Eigen/Core>
#include <oneapi/tbb/parallel_for.h>

namespace selvage::sim {

/// Calls body(i) for i in [0, count). `body` writes only what belongs to i. The grain is large enough (measured: about
/// 10 us of spring work) that small scenes stay on one thread.
template <class Body>
void parallel_each(Eigen::Index count, Body body) {
  constexpr Eigen::Index kGrain = 1024;
  tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, count, kGrain), [&](const auto& range) {
    for (Eigen::Index i = range.begin(); i < range.end(); ++i) body(i);
  });
}

}  // namespace selvage::sim
