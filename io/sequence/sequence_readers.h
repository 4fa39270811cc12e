// The readers behind open_sequence(), one a source.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/byte_source.h"
#include "io/point_cache.h"
#include "io/sequence.h"

namespace selvage::io {

/// A folder with sequence.json: docs/formats.md.
[[nodiscard]] std::unique_ptr<SequenceReader> open_folder_sequence(const std::filesystem::path& folder);
/// Its header, faces and frames; none where there is no header, for that is no sequence.
[[nodiscard]] std::vector<std::filesystem::path> folder_sequence_files(const std::filesystem::path& folder);
/// Of an .npz, in which every change between cloth and bodies begins one. A scene has some dozens; a group for every
/// face would take far more memory than the file.
inline constexpr std::size_t kMaxNpzGroups = 4096;
/// An .npz with V, F and maybe group; `name` appears in errors.
[[nodiscard]] std::unique_ptr<SequenceReader> open_npz_sequence(std::shared_ptr<const ByteSource> source,
                                                                std::string name);
/// A PC2 or MDD with the mesh that it moves: `base` gives the faces and groups, its positions are not used.
[[nodiscard]] std::unique_ptr<SequenceReader> open_point_cache(std::shared_ptr<const ByteSource> source,
                                                               PointCacheFormat format, MeshData base,
                                                               std::string name);
/// cloth.obj, or else cloth.ply, beside cloth.pc2. Throws Error if there is neither.
[[nodiscard]] std::filesystem::path find_base_mesh(const std::filesystem::path& cache);
/// Mesh files, one a frame. All are read once here: a damaged frame is found before work starts on the first.
[[nodiscard]] std::unique_ptr<SequenceReader> open_mesh_files(std::vector<std::filesystem::path> files);

/// Throws Error if there is no triangle.
void check_is_surface(const Triangles& triangles, const std::string& name);
/// Throws Error if a triangle names a vertex that is not there.
void check_indices(const Triangles& triangles, std::size_t vertex_count, const std::string& name);
/// Throws Error unless the groups lie within the faces.
void check_groups(const std::vector<Group>& groups, std::size_t face_count, const std::string& name);

}  // namespace selvage::io
