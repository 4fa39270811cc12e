// Parallel loops of tasks that are nobody else's.
#pragma once

#include <cstddef>
#include <utility>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#include <tbb/task_group.h>

namespace selvage {

/// tbb::parallel_for(arguments...), for loops in what a host may call from within a task of its own. There oneTBB's own
/// loops are the host's as well:
/// - where the host cancels its tasks, or something is thrown in one of them, a loop ends early without a word, and all
///   that it has not looked at counts as free of collisions;
/// - a thread that waits for the end of a loop is given another task of the host meanwhile, which may call for the same
///   object of this thread while that is in use.
/// Loops within these tasks belong to them, and are oneTBB's. Throws what a task throws. Costs some 100 ns more.
template <typename... Arguments>
void own_parallel_for(Arguments&&... arguments) {
  tbb::this_task_arena::isolate([&] {
    tbb::task_group_context own(tbb::task_group_context::isolated);
    tbb::parallel_for(std::forward<Arguments>(arguments)..., own);
  });
}

/// Calls body() as such a task: for what divides itself.
template <typename Body>
void in_own_task(const Body& body) {
  own_parallel_for(std::size_t{0}, std::size_t{1}, [&](std::size_t) { body(); });
}

}  // namespace selvage
