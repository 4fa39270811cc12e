// Ranges of numbers on the command line. CLI11's own hold NaN to be within any range, print the ends of an open one
// with 309 digits, and let an unsigned option wrap "-1" around.
#pragma once

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

}  // namespace selvage::cli
