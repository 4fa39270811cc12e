// Work in a process of its own, so that its peak of memory is its own.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace selvage::bench {

struct ChildOutcome {
  std::string answer;
  std::int64_t peak_bytes = 0;  ///< most memory resident at once, pages shared with the parent included
};

/// Runs `body` in a fork of this process and returns what it answers; an exception in it is thrown here as
/// std::runtime_error with the same message. REQUIRES that this process has no other threads (they would be missing in
/// the child): std::logic_error otherwise. Linux.
[[nodiscard]] ChildOutcome run_in_child(const std::function<std::string()>& body);

}  // namespace selvage::bench
