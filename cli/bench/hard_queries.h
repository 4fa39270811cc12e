// The fuzzer's classes of hard queries as sets for `selvage bench methods`.
#pragma once

#include <vector>

#include "bench/method_bench.h"

namespace selvage::cli {

/// One set for each group of classes, A to J, of about `count` queries: the classes of the group and both kinds have
/// equal shares, but for those whose exact answers are so slow that they are diluted. Every bit depends on `count`
/// alone.
[[nodiscard]] std::vector<bench::QuerySet> hard_query_sets(int count);

}  // namespace selvage::cli
