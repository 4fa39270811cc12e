// A part of a long sequence: shard i of N.
#pragma once

#include <cstddef>
#include <string>
#include <utility>

namespace selvage::cli {

struct Shard {
  std::size_t index = 1, count = 1;  ///< 1 <= index <= count
};

/// "2/8", or "auto": from SLURM_ARRAY_TASK_ID, _MIN, _MAX and _COUNT. Throws UsageError.
[[nodiscard]] Shard parse_shard(const std::string& text);
/// Its frames [first, end): shards are neighbours and differ by one frame at most. Throws UsageError if there are more
/// shards than frames.
[[nodiscard]] std::pair<std::size_t, std::size_t> frames_of(const Shard& shard, std::size_t frame_count);

}  // namespace selvage::cli
