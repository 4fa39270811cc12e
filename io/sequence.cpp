#include "io/sequence.h"

#include <cmath>
#include <system_error>
#include <utility>

#include "io/fail.h"
#include "io/file/extension.h"
#include "io/mesh_reader.h"
#include "io/sequence/sequence_readers.h"

namespace selvage::io {

std::unique_ptr<SequenceReader> open_sequence(const std::vector<std::filesystem::path>& sources,
                                              const std::filesystem::path& base) {
  if (sources.empty()) bad_input("sequence", "no file is named; name a folder, an .npz, a point cache or mesh files");
  std::error_code status;
  const std::filesystem::path& first = sources.front();
  const bool is_folder = std::filesystem::is_directory(first, status);
  const bool is_cache = !is_folder && is_point_cache(first);
  const bool is_npz = !is_folder && has_extension(first, ".npz");
  if (!base.empty() && !is_cache) bad_input(base.string(), "only a .pc2 or .mdd needs a base mesh; leave it out");
  if (!is_folder && !is_npz && !is_cache) {
    const bool is_mesh = has_extension(first, ".obj") || has_extension(first, ".ply");
    if (!is_mesh && std::filesystem::is_regular_file(first, status)) {
      bad_input(first.string(),
                "the extension is none of .obj, .ply, .npz, .pc2 and .mdd; convert it, or name a folder");
    }
    return open_mesh_files(sources);
  }
  if (sources.size() > 1) {
    const std::string what = is_folder ? "a folder" : is_npz ? "an .npz" : "a point cache";
    bad_input(first.string(),
              what + " is a sequence by itself; name it alone" + (is_cache ? ", its base mesh with --base" : ""));
  }
  if (is_folder) return open_folder_sequence(first);
  if (is_npz) return open_npz_sequence(open_file(first), first.string());
  std::shared_ptr<const ByteSource> cache = open_file(first);  // a file that is missing is that, not one without base
  MeshData mesh = read_mesh(base.empty() ? find_base_mesh(first) : base);
  return open_point_cache(std::move(cache), point_cache_format(first), std::move(mesh), first.string());
}

bool has_times(const SequenceReader& sequence) {
  if (sequence.counts_frames() || sequence.frame_count() == 0) return false;
  const double first = sequence.time(0);
  if (first != std::floor(first)) return true;
  for (std::size_t frame = 1; frame < sequence.frame_count(); ++frame) {
    if (sequence.time(frame) != first + static_cast<double>(frame)) return true;
  }
  return false;
}

std::vector<std::filesystem::path> sequence_files(const std::vector<std::filesystem::path>& sources,
                                                  const std::filesystem::path& base) {
  std::vector<std::filesystem::path> files = sources;
  if (!base.empty()) files.push_back(base);
  if (sources.empty()) return files;
  std::error_code status;
  const std::filesystem::path& first = sources.front();
  if (std::filesystem::is_directory(first, status)) return folder_sequence_files(first);
  const bool has_base_beside = base.empty() && is_point_cache(first) && std::filesystem::exists(first, status);
  if (has_base_beside) files.push_back(find_base_mesh(first));
  return files;
}

void check_is_surface(const Triangles& triangles, const std::string& name) {
  if (triangles.empty()) bad_input(name, "no face; write the array of the surface's corners, #F by 3");
}

void check_indices(const Triangles& triangles, std::size_t vertex_count, const std::string& name) {
  for (std::size_t face = 0; face < triangles.size(); ++face) {
    for (const std::int32_t vertex : triangles[face]) {
      if (vertex >= 0 && static_cast<std::size_t>(vertex) < vertex_count) continue;
      bad_input(name, "face " + std::to_string(face) + " names vertex " + std::to_string(vertex) + " of " +
                          std::to_string(vertex_count) + "; correct the faces");
    }
  }
}

void check_groups(const std::vector<Group>& groups, std::size_t face_count, const std::string& name) {
  for (const Group& group : groups) {
    if (0 <= group.face_begin && group.face_begin <= group.face_end &&
        static_cast<std::size_t>(group.face_end) <= face_count) {
      continue;
    }
    bad_input(name, "the group " + in_quotes(group.name) + " is not within the " + std::to_string(face_count) +
                        " faces; correct its range");
  }
}

}  // namespace selvage::io
