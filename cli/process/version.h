// Version of the program and of the libraries its answers depend on.
#pragma once

#include <string>

namespace selvage::cli {

[[nodiscard]] std::string version_text();

}  // namespace selvage::cli
