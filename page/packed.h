// Bytes as text of a page: deflated (zlib), then base64.
#pragma once

#include <string>
#include <string_view>

namespace selvage::page {

/// RFC 4648, section 4, with padding.
[[nodiscard]] std::string base64(std::string_view bytes);
/// base64 of the bytes as a zlib stream, which DecompressionStream("deflate") of a browser inflates.
[[nodiscard]] std::string packed(std::string_view bytes);

}  // namespace selvage::page
