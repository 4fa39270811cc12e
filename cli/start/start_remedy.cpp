#include "cli/start/start_remedy.h"

#include <algorithm>
#include <array>
#include <set>

#include <fmt/format.h>

#include "cli/answer/mesh_faults.h"
#include "cli/answer/part_name.h"
#include "sim/base/points.h"

namespace selvage::cli {
namespace {

class Faults {
 public:
  Faults(const sim::World& world, const Positions& x) : world_(world), points_(sim::points_of(x)) {}

  [[nodiscard]] static bool is_without_area(const sim::FacePair& pair) { return pair[0] == pair[1]; }

  [[nodiscard]] bool is_twice(const sim::FacePair& pair) const {
    return !is_without_area(pair) && std::ranges::is_permutation(corners(pair[0]), corners(pair[1]));
  }

  /// Corners of both, if of one part, that lie, to the bit, where one of the other face lies.
  [[nodiscard]] std::set<VertexId> coincident(const sim::FacePair& pair) const {
    if (part_with_face(world_, pair[0]) != part_with_face(world_, pair[1])) return {};
    return coincident_corners(world_.triangles, points_, pair);
  }

  [[nodiscard]] std::string name_of_part(FaceId face) const { return part_of_face(world_, face); }

 private:
  [[nodiscard]] std::array<VertexId, 3> corners(FaceId face) const {
    return world_.triangles[static_cast<std::size_t>(face)];
  }

  const sim::World& world_;
  const io::Points points_;
};

struct Seams {
  std::set<VertexId> coincident;  ///< vertices of pairs; none where no pair is at a seam
  std::string part;               ///< of the first pair that is
};

Seams find_seams(const Faults& faults, std::span<const sim::FacePair> pairs) {
  Seams seams;
  for (const sim::FacePair& pair : pairs) {
    const std::set<VertexId> more = faults.coincident(pair);
    if (seams.part.empty() && !more.empty()) seams.part = faults.name_of_part(pair[0]);
    seams.coincident.insert(more.begin(), more.end());
  }
  return seams;
}

/// Empty where no pair is at a seam.
std::string seam_remedy(const Faults& faults, std::span<const sim::FacePair> pairs) {
  const auto [coincident, part] = find_seams(faults, pairs);
  if (coincident.empty()) return {};
  return fmt::format(
      "the mesh of \"{}\" is split at seams, where {} of these vertices lie at the place of another: weld them to one "
      "(merge by distance 0) in the program that wrote it",
      part, coincident.size());
}

}  // namespace

std::string start_remedy(const sim::World& world, const Positions& x, std::span<const sim::FacePair> pairs,
                         bool repair_failed) {
  const Faults faults(world, x);
  if (std::ranges::any_of(pairs, Faults::is_without_area)) return "take the faces without area out of the mesh";
  for (const sim::FacePair& pair : pairs) {
    if (!faults.is_twice(pair)) continue;
    return fmt::format("faces {} and {} have the same corners: take one of them out of the mesh", pair[0], pair[1]);
  }
  for (const sim::FacePair& pair : pairs) {
    if (is_of_one_fan(world.triangles, pair)) return fan_remedy(pair);
  }
  const std::string move = repair_failed ? "move them apart" : "move them apart, or let --repair do it";
  const std::string seams = seam_remedy(faults, pairs);
  if (seams.empty()) return move;
  const bool nothing_else =
      std::ranges::none_of(pairs, [&](const sim::FacePair& pair) { return faults.coincident(pair).empty(); });
  if (!nothing_else) return seams + "; the others: " + move;
  return repair_failed ? seams : seams + ", or have --repair open them";
}

std::string note_on_freed(const sim::World& world, const Positions& x, std::span<const sim::FacePair> pairs) {
  for (const sim::FacePair& pair : pairs) {
    if (is_of_one_fan(world.triangles, pair)) return fan_remedy(pair) + ", or go on with another shape than it had";
  }
  const auto [coincident, part] = find_seams(Faults(world, x), pairs);
  if (coincident.empty()) return {};
  return fmt::format(
      "the mesh of \"{}\" was split at seams, where {} of these vertices lay at the place of another; they are open "
      "now, "
      "and nothing holds them together: weld them (merge by distance 0) in the program that wrote it to keep them",
      part, coincident.size());
}

}  // namespace selvage::cli
