// What a line of a picture is called.
#pragma once

#include <string>
#include <string_view>

#include <fmt/format.h>

namespace selvage::cli {

/// "cgal, 2 threads".
[[nodiscard]] inline std::string series_name(std::string_view method, int thread_count) {
  return fmt::format("{}, {} thread{}", method, thread_count, thread_count == 1 ? "" : "s");
}

}  // namespace selvage::cli
