// An algebraic time as its readers see it: rational bounds, as text.
#pragma once

#include <string>

namespace selvage::verify {

/// An exact time in [0,1]: lower == upper, or the only root of an integer polynomial in the open interval between them.
/// Ends are rationals in text, in lowest terms: "0", "1", "5/8".
struct ExactTime {
  std::string lower = "0", upper = "0";
  double lower_approx = 0;  ///< largest double <= lower
  double upper_approx = 0;  ///< smallest double >= upper
};

}  // namespace selvage::verify
