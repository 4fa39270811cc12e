// The second decider of faces, but it never finds anything: linked into a program whose deciders therefore differ.
#include "verify/decision/second_opinion.h"

namespace selvage::verify {

bool second_opinion_overlap(const std::array<std::int32_t, 3>&, const std::array<Point, 3>&,
                            const std::array<std::int32_t, 3>&, const std::array<Point, 3>&) {
  return false;
}

bool second_opinion_degenerate(const std::array<Point, 3>&) { return false; }

}  // namespace selvage::verify
