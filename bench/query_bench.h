// Speed against error on files of queries: the kernel, the textbook method and the exact checker side by side.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/toi_error.h"
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

struct QueryBenchOptions {
  double tolerance = 0;  ///< of the kernel, at t = 1; the truth is about touching, so 0 compares like with like
  int repeat = 5;        ///< timed passes over all queries, >= 1
};

/// Nanoseconds a query. The mean is the best pass, timed as a whole in processor time of the thread. The others are
/// single queries in wall time, each at its best over the passes, with the clock's own cost in them (`clock_ns`).
struct QueryTimes {
  double mean = 0, median = 0, p99 = 0, max = 0;
};

struct MethodReport {
  std::string name;
  std::int64_t false_negatives = 0, false_positives = 0;
  std::int64_t unresolved = 0;  ///< counted as positive answers
  ToiError toi;
  QueryTimes ns;
};

struct QueryBenchReport {
  std::vector<std::string> files;
  std::int64_t queries = 0, positives = 0;
  std::int64_t truth_in_files = 0;        ///< queries with a truth column; the exact checker speaks for the others
  std::vector<std::string> contradicted;  ///< by the exact checker: FILE:LINE of queries with a wrong truth column
  double clock_ns = 0;                    ///< cost of reading the clock twice
  std::vector<MethodReport> methods;      ///< kernel, textbook, exact
};

/// One thread; every pass visits the queries in a new order that depends on the pass alone, after one untimed pass.
/// REQUIRES at least one query.
[[nodiscard]] QueryBenchReport run_query_bench(std::span<const QueryFile> files, const QueryBenchOptions& options);

/// Schema selvage.bench.queries/1.
[[nodiscard]] std::string to_json(const QueryBenchReport& report);

}  // namespace selvage::bench
