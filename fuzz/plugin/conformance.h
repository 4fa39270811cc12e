// The query level as a conformance test for anyone's collision code: a plugin against exact arithmetic.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "fuzz/campaign/property.h"
#include "fuzz/ledger/ledger.h"
#include "fuzz/plugin/plugin.h"

namespace selvage::fuzz {

/// Streams for all classes, vf and ee, and for queries that come about as near as the gap that the plugin declares.
/// Failures: missed, late-time, alarm-too-far, unsteady, and
/// the misdeeds of Plugin::Answer.
/// A process that finds another CRC-32 than `crc32` of the library does not start.
[[nodiscard]] std::unique_ptr<Property> make_conformance(const std::filesystem::path& library, std::uint32_t crc32,
                                                         const DeclaredGap& gap);

/// What the property above counts in a stream.
struct ConformanceRow {
  /// Places in Counts::of, in the order of its counters.
  enum Counter : std::uint8_t { kTouches, kAlarms, kMissed, kLate, kTooFar, kNanoseconds };

  std::int64_t queries = 0, touches = 0, alarms = 0;
  std::int64_t missed = 0, late = 0, too_far = 0;
  std::int64_t misdeeds = 0;  ///< failures of any other kind
  std::int64_t nanoseconds = 0;

  explicit ConformanceRow(const Counts& counts);
  [[nodiscard]] double nanoseconds_per_query() const;
};

/// The report on a campaign with the property above: a line for each class with queries, touches, misses, late times,
/// alarms beyond the declared gap and time a query; then every finding with its smallest counterexample.
[[nodiscard]] std::string conformance_text(const Ledger& ledger, const PluginInfo& info, const std::string& folder);
/// "selvage.conformance/1".
[[nodiscard]] std::string conformance_json(const Ledger& ledger, const PluginInfo& info);

}  // namespace selvage::fuzz
