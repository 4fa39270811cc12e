// A range of frames on the command line.
#pragma once

#include <cstddef>
#include <string>

namespace selvage::cli {

/// Half-open, as in Python.
struct FrameRange {
  std::size_t begin = 0, end = 0;
};

/// "a:b", ":b", "a:" or ":" of `frame_count` frames. Throws UsageError: another form, an empty range, or one that
/// reaches beyond the frames.
[[nodiscard]] FrameRange parse_frame_range(const std::string& text, std::size_t frame_count);

}  // namespace selvage::cli
