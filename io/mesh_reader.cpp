#include "io/mesh_reader.h"

#include "io/fail.h"
#include "io/file/atomic_file.h"
#include "io/file/extension.h"

namespace selvage::io {

MeshData read_mesh(const std::filesystem::path& file) {
  const std::string bytes = read_file(file);  // a path that does not exist is that first, whatever its extension
  if (has_extension(file, ".obj")) return parse_obj(bytes, file.string());
  if (has_extension(file, ".ply")) return parse_ply(bytes, file.string());
  bad_input(file.string(), "the extension is neither .obj nor .ply; convert the mesh");
}

}  // namespace selvage::io
