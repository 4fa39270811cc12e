// The little JSON that a page needs, without a library for it.
#pragma once

#include <string>
#include <string_view>

namespace selvage::page {

/// A quoted JSON string, in which a byte that is not part of valid UTF-8 becomes U+FFFD, as in text().
[[nodiscard]] std::string json_string(std::string_view plain);
/// A number with the same bits when it is read back. REQUIRES finite.
[[nodiscard]] std::string json_number(double value);

}  // namespace selvage::page
