#include "cli/arguments/frame_range.h"

#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

#include "cli/process/exit_code.h"

namespace selvage::cli {
namespace {

/// Digits alone; `absent` for an empty text.
std::optional<std::size_t> parse_bound(std::string_view text, std::size_t absent) {
  if (text.empty()) return absent;
  std::size_t value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

FrameRange parse_frame_range(const std::string& text, std::size_t frame_count) {
  const std::size_t colon = text.find(':');
  const std::string_view view = text;
  const auto begin = parse_bound(view.substr(0, colon), 0);
  const auto end = parse_bound(colon == text.npos ? "" : view.substr(colon + 1), frame_count);
  if (colon == text.npos || !begin || !end) throw UsageError("--frames " + text + " is not a:b, :b or a:");
  if (*begin >= *end || *end > frame_count) {
    throw UsageError("--frames " + text + " is not within the " + std::to_string(frame_count) +
                     " frames, which count from 0; b is the first that is left out");
  }
  return {*begin, *end};
}

}  // namespace selvage::cli
