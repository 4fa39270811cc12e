// What lines of a picture are called.
#pragma once

#include <string>
#include <string_view>

#include <fmt/format.h>

namespace selvage::cli {

/// "2 threads".
[[nodiscard]] inline std::string threads_name(int thread_count) {
  return fmt::format("{} thread{}", thread_count, thread_count == 1 ? "" : "s");
}

/// "cgal, 2 threads".
[[nodiscard]] inline std::string series_name(std::string_view method, int thread_count) {
  return fmt::format("{}, {}", method, threads_name(thread_count));
}

}  // namespace selvage::cli
