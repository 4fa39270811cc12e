// Frees cloth from bodies: they give way, and come back.
#pragma once

#include "sim/repair/untangle_state.h"

namespace selvage::sim {

/// Bodies may intersect themselves and each other, so they can be drawn in along their normals, by one gap, two, four,
/// and so on to half of their size, until no cloth intersects them; or stand beside the cloth, in one of six
/// directions. From there they come back in steps that CollisionStep certifies, pushing the cloth out of their way. The
/// first depth from which they can is taken, else the direction that moves the cloth least. Closed
/// parts whose faces look outwards are drawn inwards; all others together to one side of their faces or the other, from
/// where the cloth is moved least. Faces of a part are wound alike. PRE: no two faces of cloth intersect. Changes the
/// cloth in state.x; false where the bodies could not come back.
[[nodiscard]] bool return_bodies(UntangleState& state);

}  // namespace selvage::sim
