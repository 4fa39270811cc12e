// Names of files are bytes; a page holds nothing but UTF-8.
#pragma once

#include <cstddef>
#include <string_view>

namespace selvage::page {

/// U+FFFD, for a byte that is part of no character.
inline constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

/// The length of the UTF-8 character that `bytes` starts with (Unicode 15, table 3-7), or 0.
[[nodiscard]] std::size_t character_length(std::string_view bytes);

}  // namespace selvage::page
