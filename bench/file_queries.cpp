#include "bench/file_queries.h"

namespace selvage::bench {

std::optional<PairKind> kind_of_path(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  if (stem.ends_with("vf")) return PairKind::kVf;
  if (stem.ends_with("ee")) return PairKind::kEe;
  for (const std::filesystem::path& folder : file.parent_path()) {
    if (folder == "vertex-face") return PairKind::kVf;
    if (folder == "edge-edge") return PairKind::kEe;
  }
  return std::nullopt;
}

std::vector<FileQuery> all_queries(std::span<const QueryFile> files) {
  std::vector<FileQuery> queries;
  for (const QueryFile& file : files) {
    std::size_t line = 1;
    for (const io::CcdQuery& read : file.queries) {
      std::array<Vec3, 4> x_t0, x_t1;
      for (std::size_t i = 0; i < 4; ++i) {
        x_t0[i] = Vec3(read.points[i].data());
        x_t1[i] = Vec3(read.points[i + 4].data());
      }
      const auto number = static_cast<std::size_t>(&file - files.data());
      queries.push_back({method_query(file.kind, x_t0, x_t1), read.truth, number, line});
      line += io::kRowsPerQuery;
    }
  }
  return queries;
}

std::string place_of(const FileQuery& query, std::span<const QueryFile> files) {
  return files[query.file].file.string() + ":" + std::to_string(query.line);
}

}  // namespace selvage::bench
