// Where a campaign is at a moment: a line of stats.jsonl for programs, and one for people who watch.
#pragma once

#include <string>

#include "fuzz/run/driver.h"

namespace selvage::fuzz {

/// A JSON object and a line end: seconds and rate of this run; of the whole campaign, for each property, cases, the
/// counters by name, the nearest miss, sharpness records by measure and kind of pairs, and failures by kind.
[[nodiscard]] std::string stats_line(const Ledger& ledger, const DriverStatus& status);

/// Without a line end: time, cases and rate of this run; of the whole campaign hits, alarms and exact decisions where
/// its properties count them, the nearest miss, and failures by kind.
[[nodiscard]] std::string status_line(const Ledger& ledger, const DriverStatus& status);

}  // namespace selvage::fuzz
