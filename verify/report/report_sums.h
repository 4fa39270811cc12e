// Whether the numbers of a report agree with each other: one that was damaged on its way must not be read as clean.
#pragma once

#include <string>

#include "verify/check.h"

namespace selvage::verify {

/// What contradicts what, in words; empty where nothing does. O(#violated + #violations).
[[nodiscard]] std::string contradiction_in(const SequenceReport& report);

}  // namespace selvage::verify
