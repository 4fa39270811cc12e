// Which proximities are contacts. Beside the pair that is nearest there are others that are near only because they
// share a corner or an edge with it: a vertex above a flat ground is within the thickness of the faces around the one
// below it, too, in slanted directions. Repelled along these, cloth that slides over the ground would stumble over
// edges at which the ground is flat.
#pragma once

#include <vector>

#include "kernel/proximities.h"
#include "sim/base/vertex_faces.h"

namespace selvage::sim {

/// The pairs at which distance is a local minimum, in their order. Left out is
/// - a vf pair whose nearest point of the face lies on an edge or corner of it, where in another direction a pair is
///   strictly nearer: of the vertex and a face that holds that edge or corner, or of an edge that holds the vertex and
///   an edge that is that edge or holds that corner. But not for an edge whose nearest point is farther from the vertex
///   than `thickness_m` and in nearly the same direction, above which the vertex is higher: else nothing would hold the
///   corner of a sheet whose next vertex is a little lower. (In one step it fell by 1 of the 3 mm on which it lay.)
/// - an ee pair whose nearest point lies at an end of an edge, where that vertex is as near to a face that holds the
///   other edge; of parallel edges, whose nearest points are anywhere, the same for all four ends.
/// A pair is left out for one that is nearer, or for a vf pair in place of an ee pair, so of any set of pairs that
/// share features the nearest stays. `proximities` as from find_proximities: sorted by (kind, first, second). Linear in
/// their number but for binary searches, and for vf pairs whose vertex holds edges that are nearer:
/// those walk its pairs; in parallel, same bits for any number of threads.
[[nodiscard]] std::vector<PairProximity> local_proximities(const Mesh& mesh, const VertexFaces& faces,
                                                           const Positions& V,
                                                           const std::vector<PairProximity>& proximities,
                                                           double thickness_m);

}  // namespace selvage::sim
