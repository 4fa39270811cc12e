// The writers behind create_output(), one a format, and what they share.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/sequence_output.h"

namespace selvage::io {

[[nodiscard]] std::unique_ptr<SequenceOutput> create_folder_output(std::filesystem::path target, OutputHeader header);
[[nodiscard]] std::unique_ptr<SequenceOutput> create_npz_output(std::filesystem::path target, OutputHeader header);
[[nodiscard]] std::unique_ptr<SequenceOutput> create_obj_output(std::filesystem::path target, OutputHeader header);
[[nodiscard]] std::unique_ptr<SequenceOutput> create_pc2_output(std::filesystem::path target, OutputHeader header);
[[nodiscard]] std::unique_ptr<SequenceOutput> create_pvd_output(std::filesystem::path target, OutputHeader header);

/// A mesh as OBJ text, each number the shortest decimal that is read as the same double. Groups become "g". Throws
/// Error(kBadInput) where the groups overlap or a name would not be read back.
[[nodiscard]] std::string obj_bytes(const MeshData& mesh, const std::string& name);
/// A mesh as VTK PolyData (XML, raw appended data): points, triangles, and `group` on cells, 0 for cloth, 1 for bodies.
[[nodiscard]] std::string vtp_bytes(const MeshData& mesh);
/// 0 for cloth, 1 for bodies, a byte a face, as .npz and .vtp hold it.
[[nodiscard]] std::string role_bytes(std::size_t face_count, const std::vector<Group>& groups);

/// cloth_000012.obj for cloth.obj.
[[nodiscard]] std::filesystem::path frame_path(const std::filesystem::path& target, std::size_t frame,
                                               const char* extension);
/// Throws Error(kBadInput) unless `mesh` has the number of vertices, the faces, and of the groups what the format
/// keeps, as the first frame has them.
void require_same_mesh(const OutputHeader& header, const MeshData& mesh, OutputFormat format,
                       const std::filesystem::path& target);

/// Removes its files when it ends, unless they are kept.
class WrittenFiles {
 public:
  WrittenFiles() = default;
  WrittenFiles(const WrittenFiles&) = delete;
  WrittenFiles& operator=(const WrittenFiles&) = delete;
  ~WrittenFiles();
  /// A new file, whole. Throws Error(kFile) where something has its name, which is none of these files and stays.
  void write(const std::filesystem::path& file, std::string_view bytes);
  void keep() { files_.clear(); }

 private:
  std::vector<std::filesystem::path> files_;
};

}  // namespace selvage::io
