// Two triangles of one mesh at one instant, kept as bits like a case of the motion (case_file.h):
//   selvage-case 1 overlap
//   seed verify:frame-12                     where it came from
//   a 17 0x1.9p+6 -0x1.2p+3 0x0p+0           a corner: the number of its vertex, its position; a b c, then d e f
//   ...                                      equal numbers are one vertex
//   expect touches                           the exact answer: touches (beyond what they share), or apart
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

#include "verify/decision/exact_overlap.h"

namespace selvage::fuzz {

struct OverlapCase {
  std::string seed;
  std::array<std::array<std::int32_t, 3>, 2> faces{};
  std::array<std::array<verify::Point, 3>, 2> x{};
  bool touches = false;
};

[[nodiscard]] std::string format_overlap_case(const OverlapCase& kept);
/// Throws io::Error naming `name` and the line.
[[nodiscard]] OverlapCase parse_overlap_case(std::string_view text, const std::string& name);

}  // namespace selvage::fuzz
