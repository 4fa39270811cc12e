// What a campaign came to, for a person.
#pragma once

#include <string>

#include "fuzz/campaign/property.h"
#include "fuzz/ledger/ledger.h"

namespace selvage::cli {

/// A table for each property, complaints about dead streams, and for each finding how to see it again.
struct FuzzTable {
  std::string text;
  bool held = true;      ///< nothing failed and no stream has gone dead
  bool is_whole = true;  ///< every stream has had a case; of a shard: one of them
};
[[nodiscard]] FuzzTable fuzz_table(const fuzz::Ledger& ledger, const fuzz::Properties& properties,
                                   const std::string& folder);

/// One line for each property: its name, its promise and its streams.
[[nodiscard]] std::string fuzz_list(const fuzz::Properties& properties);

}  // namespace selvage::cli
