#include "verify/search/float_frame.h"

#include <algorithm>
#include <cmath>

namespace selvage::verify {

FloatFrame FloatFrame::over(const Box& bounds) {
  FloatFrame frame;
  double half_extent = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    frame.center_half[k] = bounds.min[k] * 0.25 + bounds.max[k] * 0.25;
    half_extent =
        std::max({half_extent, bounds.max[k] * 0.5 - frame.center_half[k], frame.center_half[k] - bounds.min[k] * 0.5});
  }
  int exponent = 0;
  std::frexp(half_extent, &exponent);  // half_extent < 2^exponent
  frame.scale = std::ldexp(1.0, std::min(-exponent, 1000));
  return frame;
}

}  // namespace selvage::verify
