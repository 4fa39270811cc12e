// CRC-32 (the one of zip, PNG and zlib): finds damaged files; any `crc32` tool or Python's zlib.crc32 computes it.
#pragma once

#include <cstdint>
#include <string_view>

namespace selvage::io {

/// Of `bytes` behind what `start` covers: crc32(b, crc32(a)) is the sum of a followed by b.
[[nodiscard]] std::uint32_t crc32(std::string_view bytes, std::uint32_t start = 0);

}  // namespace selvage::io
