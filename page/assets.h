// The files of assets/, which the build puts into the program.
#pragma once

#include <string>
#include <string_view>

namespace selvage::page {

/// The content of assets/`name`. REQUIRES that CMakeLists.txt lists it.
[[nodiscard]] std::string asset(std::string_view name);

}  // namespace selvage::page
