// Numbers on the command line, decimal as in files. CLI11's own ranges hold NaN to be within any of them, print the
// ends of an open one with 309 digits, let an unsigned option wrap "-1" around, and take "0x10" for 16 and "010" for 8.
#pragma once

#include <cstdint>

#include <CLI/CLI.hpp>

namespace selvage::cli {

/// A finite number, `least` and `most` included.
[[nodiscard]] CLI::Validator number_between(double least, double most);
/// A finite number, `least` included.
[[nodiscard]] CLI::Validator number_from(double least);
/// A finite number, `bound` left out.
[[nodiscard]] CLI::Validator number_above(double bound);
/// Digits alone, for options that are unsigned.
[[nodiscard]] CLI::Validator whole_number();
/// For options that are integers, `least` and `most` included.
[[nodiscard]] CLI::Validator whole_between(std::int64_t least, std::int64_t most);

}  // namespace selvage::cli
