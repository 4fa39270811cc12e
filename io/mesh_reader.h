// Reads one mesh from OBJ or PLY (ascii, little- and big-endian, float and double), bit-exactly, with bounded memory.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "io/error.h"
#include "io/mesh_data.h"

namespace selvage::io {

/// By extension (.obj, .ply). Polygons are split into fans. Throws Error: syntax, index out of range of the final
/// vertex count, repeated corner, NaN or infinity, truncation, trailing garbage. Zero-area and duplicate faces are
/// kept.
[[nodiscard]] MeshData read_mesh(const std::filesystem::path& file);

/// The parsers behind it, on bytes in memory (what the fuzzers call). `name` appears in errors.
[[nodiscard]] MeshData parse_obj(std::string_view bytes, const std::string& name);
[[nodiscard]] MeshData parse_ply(std::string_view bytes, const std::string& name);

}  // namespace selvage::io
