// Whether a collision step can be done at all: options, sizes, domain, masses, lattice.
#pragma once

#include <string_view>

#include "kernel/mesh.h"
#include "sim/contact/collision_bodies.h"
#include "sim/contact/collision_options.h"
#include "sim/contact/repulsion_contact.h"

namespace selvage::sim {

/// The name of the first option that does not lie in the range that CollisionOptions states, as of which a step says
/// kBadOption; empty where all do.
[[nodiscard]] std::string_view first_bad_option(const CollisionOptions& options);

/// The first thing wrong with the input of a step, or kNone. O(#V).
[[nodiscard]] InputError validate_step_input(const Mesh& mesh, const CollisionOptions& options,
                                             const PositionsRef& V_t0, const PositionsRef& V_candidate,
                                             const CollisionBodies& bodies, double dt_s);

/// kBadContact where a contact given to a step is no vf or ee pair of the mesh with the vertices of that, has a number
/// that is not finite or out of its range, or a normal that is no unit vector; else kNone. O(#contacts).
[[nodiscard]] InputError validate_held(const Mesh& mesh, std::span<const RepulsionContact> held);

}  // namespace selvage::sim
