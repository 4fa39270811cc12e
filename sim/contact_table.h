// The contact properties of every pair of a mesh.
#pragma once

#include <array>

#include "kernel/mesh.h"
#include "sim/collision_step.h"

namespace selvage::sim {

class ContactTable {
 public:
  /// The properties of `options` for all pairs where `surfaces` has none.
  ContactTable(const Mesh& mesh, const CollisionOptions& options, ContactSurfaces surfaces);

  /// kNone, or what is wrong with the surfaces: kBadOption (a value out of its range) or kBadSurfaces. Nothing else may
  /// be asked then.
  [[nodiscard]] InputError error() const { return error_; }

  /// Whether all pairs have the same properties.
  [[nodiscard]] bool is_uniform() const { return surface_.empty(); }
  /// `pair` as from pair_vertices().
  [[nodiscard]] ContactProperties of(PairKind kind, const std::array<VertexId, 4>& pair) const;
  /// At least those of any pair.
  [[nodiscard]] double thickness_upper() const { return thickness_upper_; }
  [[nodiscard]] double tolerance_upper() const { return tolerance_upper_; }

 private:
  std::vector<ContactProperties> properties_;  ///< at least one
  std::vector<std::int32_t> surface_;          ///< #V; empty where uniform
  double thickness_upper_ = 0, tolerance_upper_ = 0;
  InputError error_ = InputError::kNone;
};

}  // namespace selvage::sim
