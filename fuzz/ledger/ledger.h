// What a campaign has done so far, as one file: replaced atomically, resumed from, and merged with those of other
// shards into the bits that one run would have written.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fuzz/base/counts.h"
#include "fuzz/ledger/range_set.h"
#include "fuzz/oracle/accuracy.h"
#include "io/error.h"

namespace selvage::fuzz {

/// The failures of one stream with one word.
struct Finding {
  std::int64_t count = 0;
  std::int64_t number = 0;  ///< the lowest case that failed so
  std::string file;         ///< its kept case, in the ledger's folder; empty: not kept yet
  friend bool operator==(const Finding&, const Finding&) = default;
};

/// In a unit: the case that is next, by its place in its stream's part of the unit.
struct UnitPlace {
  std::int64_t stream = 0, number = 0;
  friend bool operator==(const UnitPlace&, const UnitPlace&) = default;
};

struct PropertyLedger {
  std::string name;
  RangeSet units;                                                   ///< done, failures included
  std::vector<std::string> streams, counters;                       ///< names
  std::vector<Counts> rows;                                         ///< a stream
  std::map<std::pair<std::string, std::string>, Finding> findings;  ///< by stream and failure
  std::map<std::int64_t, UnitPlace> open = {};                      ///< units cut short: what is before is counted
  std::vector<Accuracy> accuracy = {};                              ///< a stream
  [[nodiscard]] Counts total() const;
  [[nodiscard]] Accuracy total_accuracy() const;
  /// Streams of which no case has run: nothing is known of them.
  [[nodiscard]] std::int64_t streams_without_cases() const;
  friend bool operator==(const PropertyLedger&, const PropertyLedger&) = default;
};

/// Of each property: campaign.json holds counts up to 2^53, which every reader of JSON takes exactly, and what is asked
/// for is rounded up to work units.
inline constexpr double kMaxCases = 1e15;
/// Far more than a scheduler's array holds, and so few that the numbers of cases stay below 2^53 as well.
inline constexpr std::size_t kMaxShards = 1'000'000;

struct Ledger {
  std::string version;  ///< of the program: the cases behind a number may change with it
  std::string target;   ///< what is attacked: "selvage", or the plugin's name
  std::uint64_t seed = 0;
  std::int64_t cases = 0;  ///< of each property, asked for; 0: as many as the time allows
  std::int64_t shard = 1, shards = 1;
  std::vector<PropertyLedger> properties;
  std::optional<std::uint32_t> plugin_crc32 = {};  ///< of the plugin's file: one that was rebuilt is another target
  friend bool operator==(const Ledger&, const Ledger&) = default;
};

[[nodiscard]] std::string to_json(const Ledger& ledger);
/// Throws io::Error(kBadInput).
[[nodiscard]] Ledger parse_ledger(const std::string& text, const std::string& name);

/// Throws io::Error(kBadInput): shards of different campaigns, a shard missing or twice.
[[nodiscard]] Ledger merge(const std::vector<Ledger>& parts);

}  // namespace selvage::fuzz
