// Which frames and motions are violated, as a row of bars.
#pragma once

#include "page/html.h"
#include "verify/check.h"

namespace selvage::cli {

/// One button a frame, or a few frames where they would not fit; a bar grows with the logarithm of the violations.
[[nodiscard]] page::Html report_timeline(const verify::SequenceReport& report);

}  // namespace selvage::cli
