// Whether a frame is violated, and where, for those who need not know of all places.
#pragma once

#include "verify/check.h"

namespace selvage::verify {

/// All that check_frame() finds where that is less than `enough`, else as many, in (event, features) order: those that
/// it comes to first, the same for any number of threads. It looks at no more than that takes: cloth in as many layers
/// as it likes at one place has as many pairs as there are. Of the options without max_violations. Throws as
/// check_frame() does. REQUIRES enough > 0.
[[nodiscard]] std::vector<Violation> first_violations(const Topology& topology, std::span<const Point> V,
                                                      std::size_t enough, CheckOptions options);

}  // namespace selvage::verify
