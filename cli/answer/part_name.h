// The cloth or body that a face or vertex belongs to, by the name that the scene gave it.
#pragma once

#include <string>

#include "sim/world.h"

namespace selvage::cli {

/// nullptr where no part holds the face: -1 owns a vertex without faces.
[[nodiscard]] const io::Group* part_with_face(const sim::World& world, FaceId face);

/// Printable; "?" where no part holds it.
[[nodiscard]] std::string part_of_face(const sim::World& world, FaceId face);
/// The same of the part that holds the vertex.
[[nodiscard]] std::string part_of_vertex(const sim::World& world, VertexId vertex);
/// "dress pin 0": the pin that holds the vertex at the time. Printable; empty where none does.
[[nodiscard]] std::string pin_of_vertex(const sim::World& world, VertexId vertex, double time_s);

}  // namespace selvage::cli
