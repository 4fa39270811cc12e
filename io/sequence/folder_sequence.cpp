// Reads the sequence folder: header and frame list when it is opened, frames on demand.
#include <utility>

#include "io/fail.h"
#include "io/file/atomic_file.h"
#include "io/file/checksum.h"
#include "io/format/npy.h"
#include "io/sequence/sequence_json.h"
#include "io/sequence/sequence_readers.h"

namespace selvage::io {
namespace {

std::string read_checked(const std::filesystem::path& file, std::optional<std::uint32_t> expected) {
  std::string bytes = read_file(file);
  if (expected && crc32(bytes) != *expected) {
    bad_input(file.string(), "the checksum differs from the one recorded; restore the file or record it again");
  }
  return bytes;
}

class FolderSequence final : public SequenceReader {
 public:
  explicit FolderSequence(std::filesystem::path folder) : folder_(std::move(folder)) {
    const std::filesystem::path header_file = folder_ / kHeaderFile;
    if (!std::filesystem::exists(header_file)) {
      bad_input(folder_.string(),
                "a folder without " + std::string(kHeaderFile) +
                    " is no sequence; name its mesh files instead, in the order of the frames, or write " +
                    "what was not written to its end again");
    }
    description_ = parse_sequence_json(read_file(header_file), header_file.string());
    const std::filesystem::path faces_file = folder_ / description_.faces_file;
    triangles_ = parse_npy_triangles(read_checked(faces_file, description_.faces_crc32), faces_file.string());
    check_is_surface(triangles_, faces_file.string());
    check_groups(description_.groups, triangles_.size(), header_file.string());
    const std::filesystem::path frames_file = folder_ / kFramesFile;
    const std::string list = read_file(frames_file);
    frames_ = parse_frame_list(list, frames_file.string());
    if (!list.empty() && !list.ends_with('\n')) {
      remark_ = frames_file.string() +
                ": the last line has no end and is left out: a frame that was being added, or one " +
                "whose list was written without its last line break; add it if the frame counts";
    }
    if (frames_.empty()) return;
    vertex_count_ = read_points(0).size();
    check_indices(triangles_, vertex_count_, faces_file.string());
  }

  std::size_t frame_count() const override { return frames_.size(); }
  SequenceKind kind() const override { return description_.kind; }
  Precision precision() const override { return description_.precision; }
  const std::vector<Group>& groups() const override { return description_.groups; }
  std::string frame_name(std::size_t frame) const override { return (folder_ / frames_.at(frame).file).string(); }
  double time(std::size_t frame) const override { return frames_.at(frame).time_s; }
  bool counts_frames() const override { return false; }
  bool same_faces_as_previous(std::size_t) const override { return true; }
  std::string remark() const override { return remark_; }

  MeshData frame(std::size_t frame) const override {
    Points points = read_points(frame);
    if (points.size() != vertex_count_) {
      bad_input(frame_name(frame), std::to_string(points.size()) + " vertices, the first frame has " +
                                       std::to_string(vertex_count_) + "; all frames must have the same");
    }
    return {std::move(points), triangles_, description_.groups, description_.precision};
  }

 private:
  Points read_points(std::size_t frame) const {
    const std::string name = frame_name(frame);
    NpyPoints read = parse_npy_points(read_checked(name, frames_[frame].crc32), name);
    if (read.precision != description_.precision) {
      bad_input(name, "the type is not the precision that sequence.json states; correct the header");
    }
    return std::move(read.points);
  }

  std::filesystem::path folder_;
  SequenceDescription description_;
  Triangles triangles_;
  std::vector<FrameRecord> frames_;
  std::size_t vertex_count_ = 0;
  std::string remark_;
};

}  // namespace

std::vector<std::filesystem::path> folder_sequence_files(const std::filesystem::path& folder) {
  const std::filesystem::path header = folder / kHeaderFile, list = folder / kFramesFile;
  if (!std::filesystem::exists(header)) return {};
  std::vector<std::filesystem::path> files = {header, list};
  files.push_back(folder / parse_sequence_json(read_file(header), header.string()).faces_file);
  for (const FrameRecord& frame : parse_frame_list(read_file(list), list.string()))
    files.push_back(folder / frame.file);
  return files;
}

std::unique_ptr<SequenceReader> open_folder_sequence(const std::filesystem::path& folder) {
  return std::make_unique<FolderSequence>(folder);
}

}  // namespace selvage::io
