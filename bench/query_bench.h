// Speed against error on files of queries: the kernel, the textbook method, the exact checker and a guest side by side.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/file_queries.h"
#include "bench/guest_method.h"
#include "bench/query_times.h"
#include "bench/toi_error.h"

namespace selvage::bench {

struct QueryBenchOptions {
  double tolerance = 0;  ///< of the kernel, at t = 1; the truth is about touching, so 0 compares like with like
  int repeat = 5;        ///< timed passes over all queries, >= 1
};

struct MethodReport {
  std::string name;
  std::int64_t false_negatives = 0, false_positives = 0;
  std::int64_t unresolved = 0;  ///< counted as positive answers
  bool gives_toi = false;
  ToiError toi;
  QueryTimes ns;
  /// Of a guest: false positives that never come within the gap that it declares.
  std::optional<std::int64_t> false_positives_beyond_gap;

  /// What no collision code may do: a miss, or a time behind the first touch.
  [[nodiscard]] bool is_unsafe() const { return false_negatives > 0 || toi.late > 0; }
};

struct QueryBenchReport {
  std::vector<std::string> files;
  std::int64_t queries = 0, positives = 0;
  std::int64_t truth_in_files = 0;        ///< queries with a truth column; the exact checker speaks for the others
  std::vector<std::string> contradicted;  ///< by the exact checker: FILE:LINE of queries with a wrong truth column
  double clock_ns = 0;                    ///< cost of reading the clock twice
  std::vector<MethodReport> methods;      ///< kernel, textbook, exact, and the guest
  std::optional<GuestFacts> guest;
};

/// One thread; every pass visits the queries in a new order that depends on the pass alone, after one untimed pass.
/// `guest` was measured before. REQUIRES at least one query.
[[nodiscard]] QueryBenchReport run_query_bench(std::span<const QueryFile> files, const QueryBenchOptions& options,
                                               const std::optional<GuestMethod<QueryTimes>>& guest = std::nullopt);

/// Schema selvage.bench.queries/1.
[[nodiscard]] std::string to_json(const QueryBenchReport& report);

}  // namespace selvage::bench
