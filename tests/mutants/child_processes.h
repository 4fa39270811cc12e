// Work in processes of its own: what crashes or hangs there says so, and leaves the others alone.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace selvage::mutants {

enum class ChildEnd : std::uint8_t { kDone, kCrashed, kTimeout };

struct ChildResult {
  ChildEnd end = ChildEnd::kCrashed;
  std::string text;    ///< what the work returned, if done
  double seconds = 0;  ///< processor time, if done
};

/// In the order of `work`, `jobs` at a time; on_end(i, result) as they end. No thread may have been started before.
std::vector<ChildResult> run_children(const std::vector<std::function<std::string()>>& work, int jobs,
                                      const std::function<void(std::size_t, const ChildResult&)>& on_end);

}  // namespace selvage::mutants
