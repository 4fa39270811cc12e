// Small valid files of every format, to damage.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace selvage::fuzz {

/// At least one. REQUIRES a name of file_formats().
[[nodiscard]] std::vector<std::string> file_samples(std::string_view format);

}  // namespace selvage::fuzz
