// Bytes as text of a page: deflated (zlib), then base64.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace selvage::page {

/// RFC 4648, section 4, with padding.
[[nodiscard]] std::string base64(std::string_view bytes);
/// base64 of the bytes as a zlib stream, which DecompressionStream("deflate") of a browser inflates.
[[nodiscard]] std::string packed(std::string_view bytes);

/// Integers as packed() bytes. `stride` in a row belong together (x, y, z): each is written as its difference, modulo
/// 2^32, from the one `stride` places before, signs folded to the lowest bit, lowest bytes of all first: neighbours
/// that are close become runs of zeros. assets/unpack.js has unpackIntegers(id, stride).
[[nodiscard]] std::string packed_integers(std::span<const std::int32_t> values, std::size_t stride);

}  // namespace selvage::page
