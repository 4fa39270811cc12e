// What held contacts begin a collision step with (held_contacts.h): what they bore in the last one.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "sim/contact/repulsion_contact.h"
#include "sim/dynamics/contact_load.h"

namespace selvage::sim {

/// By contact; zero where nothing was borne. Each load goes whole to the contact of its pair, and once more, in equal
/// parts, to those of its vertex on faces beside that have none: over an edge or a corner of the surface a vertex lies
/// on any of the faces there, and another may be found than the one that bore it. What is too much they take back.
/// With all of it for each of them a fan of 150 faces around a vertex, folded over the tip of a needle, began a step
/// with 150 times what the tip had borne, and flew off at 100 m/s; without those beside while the pair itself is held
/// sheets over a ball come to rest less often (docs/stability.md). `faces` of the mesh. O(contacts), log of the loads.
[[nodiscard]] std::vector<ContactLoad> first_loads(std::span<const RepulsionContact> contacts,
                                                   const ContactLoads& loads,
                                                   std::span<const std::array<VertexId, 3>> faces);

}  // namespace selvage::sim
