#include "io/sequence.h"

#include <system_error>

#include "io/fail.h"
#include "io/sequence_readers.h"

namespace selvage::io {

std::unique_ptr<SequenceReader> open_sequence(const std::vector<std::filesystem::path>& sources) {
  if (sources.empty()) bad_input("sequence", "no file is named; name a folder, an .npz or mesh files");
  std::error_code status;
  const std::filesystem::path& first = sources.front();
  const bool is_folder = std::filesystem::is_directory(first, status);
  if (!is_folder && first.extension() != ".npz") return open_mesh_files(sources);
  if (sources.size() > 1) bad_input(sources[1].string(), "a folder or an .npz is a sequence by itself; name it alone");
  return is_folder ? open_folder_sequence(first) : open_npz_sequence(open_file(first), first.string());
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
