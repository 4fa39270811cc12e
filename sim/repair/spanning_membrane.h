// Vertices at the mean of their neighbours: what repairs a start draws cloth towards it.
#pragma once

#include <optional>
#include <vector>

#include "kernel/mesh.h"

namespace selvage::sim {

using Region = std::vector<VertexId>;                   // sorted
using Neighbours = std::vector<std::vector<VertexId>>;  // #V: the other ends of its edges

[[nodiscard]] Neighbours neighbours_of(const Mesh& mesh);

/// region.size() for a vertex that is not in it.
[[nodiscard]] std::size_t index_in(const Region& region, VertexId v);

/// Where each of the region is at the mean of its neighbours and all others are where x has them: Laplace's equation on
/// the edges. None where it cannot be solved. REQUIRES a way over edges from all of the region to what is not in it.
[[nodiscard]] std::optional<Positions> spanning_membrane(const Neighbours& neighbours, const Region& region,
                                                         const Positions& x);

}  // namespace selvage::sim
