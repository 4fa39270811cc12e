// Commands that reports print for people to copy.
#pragma once

#include <string>

namespace selvage::cli {

/// What a shell takes as one word.
[[nodiscard]] std::string shell_word(const std::string& plain);

}  // namespace selvage::cli
