// Rigid impact zones: vertices whose collisions impulses could not resolve move together as one rigid body
// (paper, 7.5).
#pragma once

#include <span>
#include <vector>

#include "sim/response/scripted_groups.h"

namespace selvage::sim {

class ImpactZones {
 public:
  /// Every vertex in a zone of its own. `groups` must outlive the zones.
  ImpactZones(VertexId vertex_count, const ScriptedGroups& groups);

  /// Merges the zones of a pair's vertices. False, and nothing is done, where they are one zone already, or where they
  /// follow different scripts: such a zone could not be rigid. n merges take O(n log #V).
  bool merge(const std::array<VertexId, 4>& pair);

  [[nodiscard]] std::int32_t zone(VertexId vertex) const { return zone_[static_cast<std::size_t>(vertex)]; }
  /// Ascending after move_grown().
  [[nodiscard]] const std::vector<VertexId>& members(std::int32_t zone) const {
    return members_[static_cast<std::size_t>(zone)];
  }
  [[nodiscard]] std::int32_t largest() const { return largest_; }  ///< vertices; 0 before the first merge

  /// Moves the cloth vertices of every zone that grew since the last call: with the script it holds, else by the
  /// momentum that `displacement` gives its nodes.
  void move_grown(const Positions& displacement, std::span<const double> inverse_mass, StepMotion& motion);

 private:
  /// What a zone follows: no script, a script at rest, or one moving group.
  [[nodiscard]] std::int32_t script_of(VertexId vertex) const;

  const ScriptedGroups& groups_;
  std::vector<std::int32_t> zone_;              ///< #V: one of the zone's vertices
  std::vector<std::vector<VertexId>> members_;  ///< by zone; empty once merged into another
  std::vector<std::int32_t> script_;            ///< by zone
  std::vector<std::int32_t> grown_;
  std::int32_t largest_ = 0;
};

}  // namespace selvage::sim
