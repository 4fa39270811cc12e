// A sequence of mesh files; the faces may change from frame to frame.
#include <utility>

#include "io/format/polygon.h"
#include "io/mesh_reader.h"
#include "io/sequence/sequence_readers.h"

namespace selvage::io {
namespace {

class MeshFilesSequence final : public SequenceReader {
 public:
  explicit MeshFilesSequence(std::vector<std::filesystem::path> files) : files_(std::move(files)) {
    Triangles previous;
    for (std::size_t i = 0; i < files_.size(); ++i) {
      MeshData mesh = read_mesh(files_[i]);
      if (mesh.precision == Precision::kFloat64) precision_ = Precision::kFloat64;
      if (i == 0) groups_ = std::move(mesh.groups);
      split_polygons_ += mesh.split_polygons;
      same_faces_.push_back(i == 0 || mesh.triangles == previous);
      previous = std::move(mesh.triangles);
    }
  }

  std::size_t frame_count() const override { return files_.size(); }
  SequenceKind kind() const override { return SequenceKind::kFrames; }
  Precision precision() const override { return precision_; }
  const std::vector<Group>& groups() const override { return groups_; }
  std::string frame_name(std::size_t frame) const override { return files_.at(frame).string(); }
  double time(std::size_t frame) const override { return static_cast<double>(frame); }
  bool counts_frames() const override { return false; }
  bool same_faces_as_previous(std::size_t frame) const override { return same_faces_.at(frame); }
  std::int64_t split_polygons() const override { return split_polygons_; }
  std::string remark() const override {
    const std::string last = files_.size() > 1 ? " to " + files_.back().string() : "";
    return split_remark(files_.front().string() + last, split_polygons_);
  }
  MeshData frame(std::size_t frame) const override { return read_mesh(files_.at(frame)); }

 private:
  std::vector<std::filesystem::path> files_;
  std::vector<bool> same_faces_;
  std::vector<Group> groups_;
  std::int64_t split_polygons_ = 0;            ///< of all files
  Precision precision_ = Precision::kFloat32;  // of the frame that stores most
};

}  // namespace

std::unique_ptr<SequenceReader> open_mesh_files(std::vector<std::filesystem::path> files) {
  return std::make_unique<MeshFilesSequence>(std::move(files));
}

}  // namespace selvage::io
