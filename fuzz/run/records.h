// How sharp a campaign of single queries was, and which class of queries made it so.
#pragma once

#include <string>
#include <vector>

#include "fuzz/ledger/ledger.h"

namespace selvage::fuzz {

/// The best value of one measure among the streams of one kind of pairs.
struct SharpnessRecord {
  /// "nearest": the nearest miss, in bits (Counts::nearest_bits). "unfiltered": of the queries that do not touch, the
  /// share for which only the exact decision could say so, in streams that have enough of them.
  std::string measure;
  std::string kind;
  std::vector<std::string> classes;  ///< all that reach it
  double value = 0;
};

/// Nothing for a property that does not judge by exact decisions, nor where a measure has no value yet.
[[nodiscard]] std::vector<SharpnessRecord> sharpness_records(const PropertyLedger& property);

}  // namespace selvage::fuzz
