// Runs something with a given number of threads, whatever the machine has.
#pragma once

#include <tbb/global_control.h>
#include <tbb/task_arena.h>

namespace selvage::testing {

template <typename Body>
void with_threads(int count, const Body& body) {
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, static_cast<std::size_t>(count));
  tbb::task_arena(count).execute(body);
}

}  // namespace selvage::testing
