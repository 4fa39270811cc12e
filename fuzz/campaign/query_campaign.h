// Bulk campaigns at the query level: every class, every kind, one property, any kernel. Case i of a class depends on
// the seed, the class's name, the kind and i alone, so chunks can run anywhere and any case can be made again.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fuzz/draw/generators.h"
#include "fuzz/kept/case_file.h"
#include "fuzz/oracle/query_property.h"

namespace selvage::fuzz {

struct Tally {
  std::int64_t cases = 0, touches = 0, hits = 0, alarms = 0, unresolved = 0, undecided = 0, failures = 0;
  Tally& operator+=(const Tally& other);
};

/// A part of the work: cases [first, first + count) of one class and kind. A unit for workers and shards.
struct Chunk {
  const QueryClass* query_class = nullptr;
  PairKind kind = PairKind::kVf;
  std::int64_t first = 0, count = 0;
};

struct Failure {
  std::string property, query_class, what;
  std::int64_t number = 0;  ///< of the case within its class and kind
  Case kept;
};

/// Seed of one case.
[[nodiscard]] std::uint64_t case_seed(std::uint64_t seed, const Chunk& chunk, std::int64_t number);

/// Calls `on_failure` for each failing case, at once.
[[nodiscard]] Tally run_chunk(const QueryProperty& property, CcdKernel kernel, std::uint64_t seed, const Chunk& chunk,
                              const std::function<void(const Failure&)>& on_failure);

/// All classes and kinds, `count` cases each (fewer where a class is diluted), starting at case `first`.
[[nodiscard]] std::vector<Chunk> make_chunks(std::int64_t first, std::int64_t count);

/// Whether the share of exact touches (hits, for a class that aims at the end) is outside the class's band by more than
/// chance (5 standard deviations) explains: a dead or drifted generator (F1). REQUIRES a tally of the property `ccd`.
[[nodiscard]] bool is_out_of_band(const QueryClass& query_class, PairKind kind, const Tally& tally);

/// Whether more of the answers were `unresolved`, at the default limit, than a useful kernel needs, beyond chance:
/// without this gate "unresolved" to everything would keep every promise.
[[nodiscard]] bool is_unresolved_too_often(PairKind kind, const Tally& tally);

}  // namespace selvage::fuzz
