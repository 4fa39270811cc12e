// Parallel loops of tasks that are nobody else's.
#pragma once

#include <utility>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

namespace selvage::verify {

/// tbb::parallel_for(arguments...), for checks that a host may ask for within a task of its own. Where the host cancels
/// its tasks, or something is thrown in one of them, oneTBB's own loop would end early without a word, and what was not
/// examined would count as clean. While it waits for the end, a thread is given tasks of this loop alone. Throws what a
/// task throws.
template <typename... Arguments>
void own_parallel_for(Arguments&&... arguments) {
  tbb::this_task_arena::isolate([&] {
    tbb::task_group_context own(tbb::task_group_context::isolated);
    tbb::parallel_for(std::forward<Arguments>(arguments)..., own);
  });
}

}  // namespace selvage::verify
