// Shrinking of texts: what is left out is not needed.
#pragma once

#include <cstdint>
#include <string>

#include "fuzz/kept/byte_case.h"

namespace selvage::fuzz {

/// Leaves out lines, then bytes, and shortens numbers, as long as it fails with the same word. Deterministic.
[[nodiscard]] ByteCase shrink(const ByteCase& kept, const std::string& failure, std::int64_t max_trials);

}  // namespace selvage::fuzz
