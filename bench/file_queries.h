// The queries of many files in one list, each with its place.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/query_methods.h"
#include "io/query_csv.h"
#include "kernel/types.h"

namespace selvage::bench {

struct QueryFile {
  std::filesystem::path file;
  PairKind kind = PairKind::kVf;
  std::vector<io::CcdQuery> queries;
};

/// From the names the public sets use: folder `vertex-face` or `edge-edge`, or a stem that ends in `vf` or `ee`.
[[nodiscard]] std::optional<PairKind> kind_of_path(const std::filesystem::path& file);

struct FileQuery {
  MethodQuery asked;
  std::optional<bool> truth;
  std::size_t file = 0, line = 0;  ///< of its first row
};

/// In the order of the files.
[[nodiscard]] std::vector<FileQuery> all_queries(std::span<const QueryFile> files);

/// FILE:LINE.
[[nodiscard]] std::string place_of(const FileQuery& query, std::span<const QueryFile> files);

}  // namespace selvage::bench
