// One line of stats.jsonl: where a campaign was at a moment.
#pragma once

#include <string>

#include "fuzz/driver.h"

namespace selvage::fuzz {

/// A JSON object and a line end: seconds and rate of this run; of the whole campaign, for each property, cases, the
/// counters by name, the nearest miss, and failures by kind.
[[nodiscard]] std::string stats_line(const Ledger& ledger, const DriverStatus& status);

}  // namespace selvage::fuzz
