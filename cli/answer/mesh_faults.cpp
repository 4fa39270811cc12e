#include "cli/answer/mesh_faults.h"

#include <algorithm>

#include <fmt/format.h>

namespace selvage::cli {

bool is_of_one_fan(const io::Triangles& triangles, const std::array<std::int32_t, 2>& faces) {
  const auto [first, last] = std::minmax(faces[0], faces[1]);
  for (std::int32_t face = first; face < last; ++face) {
    const auto &here = triangles[static_cast<std::size_t>(face)], &next = triangles[static_cast<std::size_t>(face) + 1];
    if (here[0] != next[0] || here[2] != next[1]) return false;
  }
  return first < last;
}

std::string fan_remedy(const std::array<std::int32_t, 2>& faces) {
  return fmt::format(
      "faces {} and {} go around one corner, as those of a polygon do, which is split into triangles around its first: "
      "one that is not convex overlaps itself then; export triangles instead",
      faces[0], faces[1]);
}

std::set<std::int32_t> coincident_corners(const io::Triangles& triangles, const io::Points& x,
                                          const std::array<std::int32_t, 2>& faces) {
  std::set<std::int32_t> found;
  for (const std::int32_t a : triangles[static_cast<std::size_t>(faces[0])]) {
    for (const std::int32_t b : triangles[static_cast<std::size_t>(faces[1])]) {
      if (a != b && x[static_cast<std::size_t>(a)] == x[static_cast<std::size_t>(b)]) found.insert({a, b});
    }
  }
  return found;
}

std::optional<std::string> note_on_polygons(const io::SequenceReader& sequence, const verify::SequenceReport& report) {
  if (sequence.split_polygons() == 0) return std::nullopt;
  std::optional<std::int64_t> frame;
  io::Triangles triangles;
  for (const verify::Violation& violation : report.violations) {
    if (violation.motion || violation.event != verify::EventKind::kOverlap) continue;
    if (frame != violation.frame) {
      frame = violation.frame;
      triangles = sequence.frame(static_cast<std::size_t>(violation.frame)).triangles;
    }
    if (is_of_one_fan(triangles, verify::faces_of(violation))) return fan_remedy(verify::faces_of(violation));
  }
  return std::nullopt;
}

}  // namespace selvage::cli
