// Which surface the vertices of a mesh are of.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/contact/contact_properties.h"
#include "sim/contact/rest_pairs.h"

namespace selvage::sim {

/// Which surface each vertex is of. Without any, all of the mesh has the properties in its CollisionOptions. Without
/// those and without rest pairs no pair costs a look.
struct ContactSurfaces {
  std::vector<ContactProperties> properties;    ///< one for each surface
  std::vector<std::int32_t> surface_of_vertex;  ///< #V: index into `properties`; the same for all corners of a face
  /// Those of every cloth that repel below another distance than its thickness (find_rest_pairs()). Fill them in where
  /// a thickness is above 0.7 of an edge, or the cloth inflates.
  std::vector<RestPair> rest_pairs{};
};

}  // namespace selvage::sim
