// PC2 and MDD files byte by byte, honest or not: written by the description of the formats, not by the room's code.
#pragma once

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace selvage::testing {

inline void append_bytes(std::string& bytes, std::uint32_t word, bool big_endian) {
  for (int k = 0; k < 4; ++k) bytes += static_cast<char>(word >> 8 * (big_endian ? 3 - k : k) & 0xff);
}
inline void append_bytes(std::string& bytes, float value, bool big_endian) {
  append_bytes(bytes, std::bit_cast<std::uint32_t>(value), big_endian);
}

/// Coordinate `axis` of `vertex` in `frame` of the caches below: all differ, and no byte order gives another of them.
inline float cache_value(std::uint32_t frame, std::uint32_t vertex, std::uint32_t axis) {
  return static_cast<float>(frame) * 100.5f - static_cast<float>(vertex) * 3.25f + static_cast<float>(axis) * 0.1f;
}

inline void append_frame(std::string& bytes, std::uint32_t frame, std::uint32_t vertex_count, bool big_endian) {
  for (std::uint32_t vertex = 0; vertex < vertex_count; ++vertex) {
    for (std::uint32_t axis = 0; axis < 3; ++axis) append_bytes(bytes, cache_value(frame, vertex, axis), big_endian);
  }
}

/// The header announces `announced` frames where it is given.
inline std::string pc2(std::uint32_t vertex_count, std::uint32_t frame_count,
                       std::optional<std::uint32_t> announced = {}, float start = 2.5f, float rate = 0.5f) {
  std::string bytes("POINTCACHE2\0", 12);
  append_bytes(bytes, 1u, false);
  append_bytes(bytes, vertex_count, false);
  append_bytes(bytes, start, false);
  append_bytes(bytes, rate, false);
  append_bytes(bytes, announced.value_or(frame_count), false);
  for (std::uint32_t frame = 0; frame < frame_count; ++frame) append_frame(bytes, frame, vertex_count, false);
  return bytes;
}

inline std::string mdd(std::uint32_t vertex_count, const std::vector<float>& times,
                       std::optional<std::uint32_t> announced = {}) {
  std::string bytes;
  append_bytes(bytes, announced.value_or(static_cast<std::uint32_t>(times.size())), true);
  append_bytes(bytes, vertex_count, true);
  for (const float time : times) append_bytes(bytes, time, true);
  for (std::uint32_t frame = 0; frame < times.size(); ++frame) append_frame(bytes, frame, vertex_count, true);
  return bytes;
}

}  // namespace selvage::testing
