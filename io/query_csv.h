// The CSV files of the public CCD query sets: eight rows a query, three rationals a row, with or without a truth
// column.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <vector>

#include "io/error.h"

namespace selvage::io {

inline constexpr std::size_t kRowsPerQuery = 8;  ///< a row a line, no others between them

struct CcdQuery {
  /// Rows 0-3: the four points at t = 0; rows 4-7: at t = 1. vf: v, f0, f1, f2. ee: ea0, ea1, eb0, eb1.
  std::array<std::array<double, 3>, 8> points;
  std::optional<bool> truth;  ///< the seventh column, where there is one
};

/// Throws Error where a rational is not exactly a double, the columns vary, or a query is incomplete.
[[nodiscard]] std::vector<CcdQuery> read_query_csv(const std::filesystem::path& file);
[[nodiscard]] std::vector<CcdQuery> parse_query_csv(std::string_view bytes, const std::string& name);

}  // namespace selvage::io
