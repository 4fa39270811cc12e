// How many sweeps of a step of the dynamics each of its held contacts takes (swept_contacts.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sim/base/vertex_faces.h"
#include "sim/contact/repulsion_contact.h"

namespace selvage::sim {

/// Up to so many of its own, however unlike the masses: 1,000 to 1 would ask for 64.
inline constexpr std::int32_t kMaxUnlikeSweeps = 32;

/// By contact: `least`, or more, up to kMaxUnlikeSweeps, where cloth presses on cloth of other mass; half as many more
/// where a contact shares a vertex with such a one. Empty where all take `least`. Always an even number more: sweeps go
/// back and forth in turn, and an odd number more would change at which end the others begin. What cannot move has no
/// mass, and connects no contacts. O(contacts), and O(#V) where there are such. REQUIRES least >= 1.
[[nodiscard]] std::vector<std::int32_t> contact_sweeps(std::span<const RepulsionContact> contacts,
                                                       const VertexFaces& faces, std::int32_t least);

}  // namespace selvage::sim
