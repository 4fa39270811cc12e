// A method that is not Selvage's, in a benchmark that knows nothing of where it comes from.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "bench/query_methods.h"

namespace selvage::bench {

/// Name of a guest's row, whatever it calls itself: it may say "kernel".
inline constexpr const char* kGuestRow = "plugin";

/// By what it is known again, and what it says of itself.
struct GuestFacts {
  std::string file, name;
  std::uint32_t crc32 = 0;        ///< of the file
  double tolerance = 0;           ///< what an alarm may be off by: a length, and to it
  double relative_tolerance = 0;  ///< this part of the query's size
  bool has_toi = false;
};
/// As every report that has a guest names it, under kGuestRow.
[[nodiscard]] nlohmann::ordered_json to_json(const GuestFacts& facts);

/// `Times` is what the benchmark measures: QueryTimes, or KindTimes.
template <typename Times>
struct GuestMethod {
  GuestFacts facts;
  std::vector<MethodAnswer> answers;  ///< to all queries, in their order
  Times ns;
  /// Of an alarm without a touch: whether the features stay farther apart than both tolerances together.
  std::function<bool(const MethodQuery&, const MethodAnswer&)> is_beyond_gap;
};

}  // namespace selvage::bench
