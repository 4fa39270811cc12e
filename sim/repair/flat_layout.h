// A part of the cloth laid out flat, as an embroidery hoop holds it: without any intersection, whatever it was before.
#pragma once

#include <optional>

#include "kernel/mesh.h"
#include "sim/repair/spanning_membrane.h"

namespace selvage::sim {

struct FlatLayout {
  Region vertices;  ///< of the part
  Positions x;      ///< where each of them is
  Vec3 across;      ///< a unit normal of the plane
};

/// The longest border of a part of the surface on a circle, as long as it is at V, and every other vertex at the mean
/// of its neighbours. No two faces meet then but in what they share, where the part with a face over that border is a
/// planar graph that stays connected without any two of its vertices (W. T. Tutte, How to draw a graph, Proc. London
/// Math. Soc. 13, 1963), or without any but two of the border, which the circle keeps apart: a disc of triangles, with
/// holes or without. Of a part with a handle, or of a Moebius strip, faces overlap, and rounding may turn tiny ones
/// over: whoever uses it judges.
/// The plane is that through the middle of the part at x, its farthest vertex, and the vertex farthest from the line
/// between these; the circle is turned, or turned over, so that the sum of squares of the border's ways from x is
/// least. Arithmetic and square roots alone: no sine and no eigenvectors, whose bits differ between systems.
/// None for a part without a border, or with an edge of three faces; or where every border visits some vertex twice, or
/// has no length. REQUIRES a part connected by edges, sorted; neighbours_of(mesh); V and x: #V by 3, finite.
[[nodiscard]] std::optional<FlatLayout> flat_layout(const Mesh& mesh, const Neighbours& neighbours, const Region& part,
                                                    const Positions& V, const Positions& x);

}  // namespace selvage::sim
