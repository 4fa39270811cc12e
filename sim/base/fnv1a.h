// FNV-1a, 64 bits: of what has to be told apart but for chance, and of nothing that anybody forges.
#pragma once

#include <cstdint>
#include <string_view>

namespace selvage::sim {

/// Of `bytes`, behind what `hash` is of.
[[nodiscard]] inline std::uint64_t fnv1a(std::string_view bytes, std::uint64_t hash = 0xcbf29ce484222325u) {
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return hash;
}

}  // namespace selvage::sim
