// Cases of the query classes as tests want them: as many of every stream, fewer of those that are dear.
#pragma once

#include "fuzz/campaign/query_streams.h"

namespace selvage::fuzz {

/// How many of the first `count` cases of a stream are left where its class is diluted.
inline std::int64_t diluted(const Stream& stream, std::int64_t count) {
  const std::int64_t one_in = query_stream(stream).query_class->dilution;
  return (count + one_in - 1) / one_in;
}

inline ChoiceSource source_of_case(std::uint64_t seed, const Stream& stream, std::int64_t number) {
  return ChoiceSource::from_seed(case_seed(seed, stream, number));
}

/// Calls body(stream, number of its case) for one case of every stream, then for the next one of each, until it says
/// false.
template <typename Body>
void for_cases_in_turn(const std::vector<Stream>& streams, const Body& body) {
  for (std::int64_t round = 0;; ++round) {
    for (const Stream& stream : streams) {
      const std::int64_t number = diluted(stream, round);
      if (number < diluted(stream, round + 1) && !body(stream, number)) return;
    }
  }
}

}  // namespace selvage::fuzz
