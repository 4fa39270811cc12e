// From a counted hit to the violation that is reported.
#pragma once

#include "verify/check.h"
#include "verify/tally.h"

namespace selvage::verify {

/// Everything but frame, motion and time.
[[nodiscard]] Violation describe(const Topology& topology, const Hit& hit);

}  // namespace selvage::verify
