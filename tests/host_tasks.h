// Calls from within tasks of a host's own.
#pragma once

#include <optional>

#include <tbb/task_group.h>

namespace selvage::testing {

/// What call() returns in a task of a group that its host has cancelled meanwhile: where a task of the group throws,
/// oneTBB does the same.
template <typename Call>
auto in_cancelled_task(const Call& call) {
  std::optional<decltype(call())> result;
  tbb::task_group host;
  host.run([&] {
    host.cancel();
    result.emplace(call());
  });
  (void)host.wait();
  return std::move(result).value();
}

}  // namespace selvage::testing
