// The contact properties of every pair of a mesh.
#pragma once

#include <vector>

#include "kernel/mesh.h"
#include "sim/contact/collision_options.h"
#include "sim/contact/contact_surfaces.h"

namespace selvage::sim {

class ContactTable {
 public:
  /// The properties of `options` for all pairs where `surfaces` has none. The mesh must outlive it.
  ContactTable(const Mesh& mesh, const CollisionOptions& options, ContactSurfaces surfaces);

  /// kNone, or what is wrong with the surfaces: kBadOption (a value out of its range) or kBadSurfaces. Nothing else may
  /// be asked then.
  [[nodiscard]] InputError error() const { return error_; }

  /// Whether all pairs have the same properties.
  [[nodiscard]] bool is_uniform() const { return surface_.empty() && rest_.empty(); }
  /// Of a pair as in PairProximity and Collision: those of its surfaces; a rest pair is no thicker than its distance.
  [[nodiscard]] ContactProperties of(PairKind kind, std::int32_t first, std::int32_t second) const;
  /// At least those of any pair.
  [[nodiscard]] double thickness_upper() const { return thickness_upper_; }
  [[nodiscard]] double tolerance_upper() const { return tolerance_upper_; }

 private:
  [[nodiscard]] ContactProperties of_surfaces(PairKind kind, std::int32_t first, std::int32_t second) const;

  const Mesh& mesh_;
  std::vector<ContactProperties> properties_;  ///< at least one
  std::vector<std::int32_t> surface_;          ///< #V; empty where all surfaces have the same properties
  RestDistances rest_;
  double thickness_upper_ = 0, tolerance_upper_ = 0;
  InputError error_ = InputError::kNone;
};

}  // namespace selvage::sim
