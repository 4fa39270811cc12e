// Timing of work that may use several threads.
#pragma once

#include <algorithm>
#include <chrono>

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "bench/measure.h"

namespace selvage::bench {

struct BestTime {  ///< nanoseconds, best of the passes
  double cpu = 0;  ///< processor time of all threads
  double wall = 0;
};

template <typename Body>
void with_threads(int count, const Body& body) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
  tbb::task_arena(count).execute(body);
}

/// Runs `body` and keeps its time where it is the best so far; `best` starts at zero, which is no time yet.
template <typename Body>
void time(BestTime& best, const Body& body) {
  const double cpu = process_nanoseconds();
  const auto wall = std::chrono::steady_clock::now();
  body();
  const BestTime taken{process_nanoseconds() - cpu,
                       std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - wall).count()};
  const auto keep_less = [](double& a, double b) { a = a == 0 ? b : std::min(a, b); };
  keep_less(best.cpu, taken.cpu);
  keep_less(best.wall, taken.wall);
}

}  // namespace selvage::bench
