// The motion of a mesh between two frames: from files, or made up.
#pragma once

#include <filesystem>

#include "io/mesh_data.h"
#include "kernel/candidates.h"

namespace selvage::bench {

struct MeshMotion {
  Mesh mesh;
  Positions V_t0, V_t1;
};

/// Two files (.obj, .ply) of one mesh. Throws io::Error(kBadInput) that names both where the meshes differ in faces or
/// in number of vertices, or leave the kernel's domain.
[[nodiscard]] MeshMotion read_mesh_motion(const std::filesystem::path& file_t0, const std::filesystem::path& file_t1);

/// The connectivity of `t0`. Throws io::Error(kBadInput) where the frames do not fit together or leave the kernel's
/// domain.
[[nodiscard]] MeshMotion mesh_motion(const io::MeshData& t0, const io::MeshData& t1);

/// A square sheet of side x side vertices, pleated so tightly that layers lie a fraction of an edge apart, roughened,
/// and moved by up to one and a half edge lengths in a direction that varies smoothly: many near pairs, some contacts.
/// `pleat_advance` is how far an edge takes the sheet along, in edges: 1 / pleat_advance layers lie over each other,
/// about. Every bit depends on the arguments alone. REQUIRES side >= 2.
[[nodiscard]] MeshMotion crumpled_sheet(int side, double pleat_advance = 0.1);

/// What the kernel's broad phase finds for the motion.
[[nodiscard]] Candidates candidates_of(const MeshMotion& motion, double tolerance);

}  // namespace selvage::bench
