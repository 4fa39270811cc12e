// Loops over vertices or springs in parallel where every item writes its own slot: same bits for any thread count.
#pragma once

#include <algorithm>
#include <vector>

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

/// The sum of body(i) for i in [0, count); `body` may write what belongs to i. Blocks of items are summed one by one
/// and then in order, so the bits depend on `count` alone. `partial` is room to work in.
template <class Body>
double parallel_sum(Eigen::Index count, std::vector<double>& partial, Body body) {
  constexpr Eigen::Index kBlock = 1024;
  partial.assign(static_cast<std::size_t>((count + kBlock - 1) / kBlock), 0);
  tbb::parallel_for(std::size_t{0}, partial.size(), [&](std::size_t block) {
    const Eigen::Index begin = static_cast<Eigen::Index>(block) * kBlock, end = std::min(count, begin + kBlock);
    double sum = 0;
    for (Eigen::Index i = begin; i < end; ++i) sum += body(i);
    partial[block] = sum;
  });
  double total = 0;
  for (const double sum : partial) total += sum;
  return total;
}

}  // namespace selvage::sim
