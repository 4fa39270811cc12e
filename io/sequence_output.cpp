#include "io/sequence_output.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <system_error>
#include <utility>

#include "io/fail.h"
#include "io/file/atomic_file.h"
#include "io/file/extension.h"
#include "io/file/text.h"
#include "io/points.h"
#include "io/sequence/sequence_outputs.h"
#include "io/sequence/sequence_readers.h"

namespace selvage::io {
namespace fs = std::filesystem;
namespace {

constexpr OutputTraits kFolderTraits = {.name = "sequence folder",
                                        .is_float32 = false,
                                        .changes_mesh = false,
                                        .keeps_times = true,
                                        .keeps_kind = true,
                                        .keeps_roles = true,
                                        .keeps_group_names = true,
                                        .is_read = true};
constexpr OutputTraits kNpzTraits = {.name = "npz",
                                     .is_float32 = false,
                                     .changes_mesh = false,
                                     .keeps_times = false,
                                     .keeps_kind = false,
                                     .keeps_roles = true,
                                     .keeps_group_names = false,
                                     .is_read = true};
constexpr OutputTraits kObjTraits = {.name = "OBJ",
                                     .is_float32 = false,
                                     .changes_mesh = true,
                                     .keeps_times = false,
                                     .keeps_kind = false,
                                     .keeps_roles = false,
                                     .keeps_group_names = true,
                                     .is_read = true};
constexpr OutputTraits kPc2Traits = {.name = "PC2",
                                     .is_float32 = true,
                                     .changes_mesh = false,
                                     .keeps_times = false,
                                     .keeps_kind = false,
                                     .keeps_roles = false,
                                     .keeps_group_names = true,
                                     .is_read = true};
constexpr OutputTraits kPvdTraits = {.name = "VTP",
                                     .is_float32 = false,
                                     .changes_mesh = true,
                                     .keeps_times = true,
                                     .keeps_kind = false,
                                     .keeps_roles = true,
                                     .keeps_group_names = false,
                                     .is_read = false};

constexpr std::pair<const char*, OutputFormat> kExtensions[] = {{".npz", OutputFormat::kNpz},
                                                                {".obj", OutputFormat::kObj},
                                                                {".pc2", OutputFormat::kPc2},
                                                                {".pvd", OutputFormat::kPvd}};

}  // namespace

OutputFormat output_format(const fs::path& target) {
  const bool has_name = target.has_filename() && target.has_extension();
  const fs::path named = has_name ? target : fs::path("name" + target.filename().string());  // ".npz" has none
  for (const auto& [extension, format] : kExtensions) {
    if (!has_extension(named, extension)) continue;
    if (!has_name) bad_input(target.string(), "there is no name before the extension; name the file, or the folder");
    return format;
  }
  if (!has_name) return OutputFormat::kFolder;
  bad_input(target.string(),
            "the extension is none that is written; name an .npz, .obj, .pc2 or .pvd, or end the name "
            "of a folder in a slash");
}

const OutputTraits& traits(OutputFormat format) {
  switch (format) {
    case OutputFormat::kNpz:
      return kNpzTraits;
    case OutputFormat::kObj:
      return kObjTraits;
    case OutputFormat::kPc2:
      return kPc2Traits;
    case OutputFormat::kPvd:
      return kPvdTraits;
    case OutputFormat::kFolder:
      break;
  }
  return kFolderTraits;
}

namespace {

void require_faces(const Triangles& triangles, const std::vector<Group>& groups, std::size_t vertex_count,
                   const fs::path& target) {
  const auto is_vertex = [&](std::int32_t v) { return v >= 0 && static_cast<std::size_t>(v) < vertex_count; };
  for (const auto& triangle : triangles) {
    if (!std::ranges::all_of(triangle, is_vertex)) {
      bad_input(target.string(), "a face names a vertex that does not exist; write the positions of all vertices");
    }
  }
  for (const Group& group : groups) {
    if (!is_within(group, triangles.size())) {
      bad_input(target.string(),
                "the group \"" + printable(group.name) + "\" names faces that do not exist; correct it");
    }
  }
  require_one_role(groups, target.string());
}

}  // namespace

void SequenceOutput::require_open() const {
  if (state_ == State::kFinished) bad_input(target_.string(), "is finished; write what follows to another");
  if (state_ == State::kFailed) {
    throw Error(ErrorKind::kFile,
                target_.string() + ": could not be written before, and may hold half a frame; start anew");
  }
}

void SequenceOutput::append(double time_s, const MeshData& mesh) {
  require_open();
  if (frame_count_ == header_.frame_count) {
    bad_input(target_.string(),
              "frame " + std::to_string(frame_count_) + " is one more than were announced; announce all");
  }
  if (!std::isfinite(time_s) || !(time_s > last_time_s_)) {
    bad_input(target_.string(),
              "frame " + std::to_string(frame_count_) + " is no later than the one before; append frames in order");
  }
  if (const auto vertex = first_not_finite(mesh.points)) {
    bad_input(target_.string(), "vertex " + std::to_string(*vertex) + " of frame " + std::to_string(frame_count_) +
                                    " is not finite; correct it");
  }
  require_faces(mesh.triangles, mesh.groups, mesh.points.size(), target_);
  state_ = State::kFailed;  // unless it is said to be otherwise
  try {
    write_frame(time_s, mesh);
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kBadInput) state_ = State::kOpen;
    throw;
  }
  state_ = State::kOpen;
  ++frame_count_;
  last_time_s_ = time_s;
}

void SequenceOutput::finish() {
  require_open();
  if (frame_count_ != header_.frame_count) {
    bad_input(target_.string(), std::to_string(frame_count_) + " frames were written, and " +
                                    std::to_string(header_.frame_count) + " announced; write all");
  }
  state_ = State::kFailed;
  commit();
  state_ = State::kFinished;
}

std::unique_ptr<SequenceOutput> create_output(const fs::path& target, OutputHeader header) {
  check_is_surface(header.sequence.triangles, target.string());
  require_faces(header.sequence.triangles, header.sequence.groups, header.vertex_count, target);
  switch (output_format(target)) {
    case OutputFormat::kNpz:
      return create_npz_output(target, std::move(header));
    case OutputFormat::kObj:
      return create_obj_output(target, std::move(header));
    case OutputFormat::kPc2:
      return create_pc2_output(target, std::move(header));
    case OutputFormat::kPvd:
      return create_pvd_output(target, std::move(header));
    case OutputFormat::kFolder:
      break;
  }
  return create_folder_output(target, std::move(header));
}

std::string role_bytes(std::size_t face_count, const std::vector<Group>& groups) {
  const std::vector<std::uint8_t> is_body = body_faces(face_count, groups);
  return {is_body.begin(), is_body.end()};
}

fs::path frame_path(const fs::path& target, std::size_t frame, const char* extension) {
  const std::string number = std::to_string(frame);
  const std::string zeros(number.size() < 6 ? 6 - number.size() : 0, '0');
  return target.parent_path() / (target.stem().string() + "_" + zeros + number + extension);
}

void require_same_mesh(const OutputHeader& header, const MeshData& mesh, OutputFormat format, const fs::path& target) {
  const SequenceHeader& first = header.sequence;
  if (mesh.points.size() != header.vertex_count || mesh.triangles != first.triangles) {
    bad_input(
        target.string(),
        "the faces or the number of vertices change between frames; write .obj or .pvd, which hold a mesh a frame");
  }
  const std::size_t faces = first.triangles.size();
  if (traits(format).keeps_group_names && mesh.groups != first.groups) {
    bad_input(target.string(), "the groups change between frames; write .obj, which holds them with every frame");
  }
  if (traits(format).keeps_roles && role_bytes(faces, mesh.groups) != role_bytes(faces, first.groups)) {
    bad_input(target.string(),
              "which faces are bodies changes between frames; write .pvd, which holds it with every frame");
  }
}

fs::path base_beside(const fs::path& cache) { return fs::path(cache).replace_extension(".obj"); }

WrittenFiles::~WrittenFiles() {
  std::error_code status;
  for (const fs::path& file : files_) fs::remove(file, status);
}

void WrittenFiles::write(const fs::path& file, std::string_view bytes) {
  require_absent(file);
  AtomicFile output(file);
  output.write(bytes);
  output.commit_new();
  files_.push_back(file);
}

}  // namespace selvage::io
