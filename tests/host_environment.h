// A host whose floating-point environment oneTBB hands to tasks.
#pragma once

#include <thread>

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

namespace selvage::testing {

/// Calls run() on a thread of its own, in an arena whose tasks begin in the environment that set() leaves.
template <typename Set, typename Run>
void in_host_environment(const Set& set, const Run& run) {
  std::thread([&] {
    set();
    oneapi::tbb::task_arena arena(2);
    arena.execute([&] {
      oneapi::tbb::parallel_for(0, 4, [](int) {});
      run();
    });
  }).join();
}

}  // namespace selvage::testing
