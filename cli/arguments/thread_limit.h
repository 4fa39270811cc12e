// How many threads a command may use. Results depend on it nowhere.
#pragma once

#include <cstddef>
#include <optional>
#include <utility>

#include <CLI/CLI.hpp>
#include <oneapi/tbb/global_control.h>

#include "cli/arguments/number_check.h"

namespace selvage::cli {

/// 0: one a core.
struct ThreadLimit {
  int most = 0;

  /// Holds from here to the end of its scope.
  [[nodiscard]] std::optional<tbb::global_control> hold() const {
    if (most == 0) return std::nullopt;
    return std::optional<tbb::global_control>(std::in_place, tbb::global_control::max_allowed_parallelism,
                                              static_cast<std::size_t>(most));
  }
};

/// --threads; `limit` must outlive the parsing.
inline void add_threads(CLI::App& command, ThreadLimit& limit) {
  command.add_option("--threads", limit.most, "Number of threads; 0: one a core. Results do not depend on it")
      ->check(whole_between(0, 1024))
      ->capture_default_str();
}

}  // namespace selvage::cli
