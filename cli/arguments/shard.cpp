#include "cli/arguments/shard.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <optional>

#include <fmt/format.h>

#include "cli/process/exit_code.h"

namespace selvage::cli {
namespace {

std::optional<std::size_t> parse_number(const std::string& text) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::size_t slurm_number(const char* name) {
  const char* text = std::getenv(name);
  const auto value = text != nullptr ? parse_number(text) : std::nullopt;
  if (!value)
    throw UsageError(fmt::format("--shard auto: {} is not set to a number; is this a Slurm array job?", name));
  return *value;
}

Shard slurm_shard() {
  const std::size_t id = slurm_number("SLURM_ARRAY_TASK_ID"), count = slurm_number("SLURM_ARRAY_TASK_COUNT");
  const std::size_t first = slurm_number("SLURM_ARRAY_TASK_MIN"), last = slurm_number("SLURM_ARRAY_TASK_MAX");
  if (first > last || last - first + 1 != count || id < first || id > last) {
    throw UsageError(
        "--shard auto: the array has gaps, so its size does not say how many shards there are; write "
        "--shard i/N");
  }
  return {id - first + 1, count};
}

}  // namespace

Shard parse_shard(const std::string& text) {
  if (text == "auto") return slurm_shard();
  const std::size_t slash = text.find('/');
  const auto index = parse_number(text.substr(0, slash));
  const auto count = slash == text.npos ? std::nullopt : parse_number(text.substr(slash + 1));
  if (!index || !count || *index < 1 || *index > *count) {
    throw UsageError("--shard wants i/N with 1 <= i <= N, or auto; not '" + text + "'");
  }
  return {*index, *count};
}

std::pair<std::size_t, std::size_t> frames_of(const Shard& shard, std::size_t frame_count) {
  if (shard.count > frame_count) {
    throw UsageError(fmt::format("--shard: {} shards of a sequence of {} frames; use at most as many as frames",
                                 shard.count, frame_count));
  }
  // The first `longer` shards hold one frame more.
  const std::size_t length = frame_count / shard.count, longer = frame_count % shard.count, before = shard.index - 1;
  const std::size_t first = before * length + std::min(before, longer);
  return {first, first + length + (before < longer ? 1 : 0)};
}

}  // namespace selvage::cli
