// Reads .npz: V (frames by #V by 3, or #V by 3), F (#F by 3), maybe group (#F: 0 cloth, 1 body). Other members are not
// read. Frames of a stored V are read on demand, so that the file may be larger than the memory.
#include <stdexcept>
#include <utility>

#include "io/byte_source.h"
#include "io/fail.h"
#include "io/file/zip_archive.h"
#include "io/format/npy.h"
#include "io/format/polygon.h"
#include "io/sequence/sequence_readers.h"

namespace selvage::io {
namespace {

std::string whole(const ByteSource& source) { return source.read(0, source.size()); }

/// Runs of faces with the same number become groups.
std::vector<Group> groups_of(const std::vector<std::int64_t>& numbers, const std::string& name) {
  std::vector<Group> groups;
  for (std::size_t face = 0; face < numbers.size(); ++face) {
    if (numbers[face] != 0 && numbers[face] != 1) {
      bad_input(name, "face " + std::to_string(face) + " has the number " + std::to_string(numbers[face]) +
                          "; write 0 for cloth, 1 for bodies");
    }
    if (face == 0 || numbers[face] != numbers[face - 1]) {
      if (groups.size() == kMaxNpzGroups)
        bad_input(name, "cloth and bodies alternate too often; sort the faces by group");
      const bool is_cloth = numbers[face] == 0;
      groups.push_back({is_cloth ? "cloth" : "body", is_cloth ? Group::Role::kCloth : Group::Role::kBody,
                        static_cast<std::int32_t>(face), 0});
    }
    groups.back().face_end = static_cast<std::int32_t>(face + 1);
  }
  return groups;
}

class NpzSequence final : public SequenceReader {
 public:
  NpzSequence(std::shared_ptr<const ByteSource> source, std::string name) : name_(std::move(name)) {
    const ZipArchive archive(std::move(source), name_);
    open_positions(archive);
    triangles_ = parse_npy_triangles(whole(*archive.open("F.npy")), member_name("F"));
    check_is_surface(triangles_, member_name("F"));
    check_indices(triangles_, vertex_count_, member_name("F"));
    if (!archive.contains("group.npy")) return;
    const std::vector<std::int64_t> numbers =
        parse_npy_integers(whole(*archive.open("group.npy")), member_name("group"));
    if (numbers.size() != triangles_.size()) {
      bad_input(member_name("group"), std::to_string(numbers.size()) + " numbers for " +
                                          std::to_string(triangles_.size()) + " faces; give one a face");
    }
    groups_ = groups_of(numbers, member_name("group"));
  }

  std::size_t frame_count() const override { return frame_count_; }
  SequenceKind kind() const override { return SequenceKind::kFrames; }
  Precision precision() const override {
    return header_.item_size == sizeof(float) ? Precision::kFloat32 : Precision::kFloat64;
  }
  const std::vector<Group>& groups() const override { return groups_; }
  std::string frame_name(std::size_t frame) const override { return name_ + "[" + std::to_string(frame) + "]"; }
  double time(std::size_t frame) const override { return static_cast<double>(frame); }
  bool counts_frames() const override { return false; }
  bool same_faces_as_previous(std::size_t) const override { return true; }

  MeshData frame(std::size_t frame) const override {
    if (frame >= frame_count_) throw std::out_of_range(frame_name(frame));
    const std::uint64_t frame_size = header_.data_size / frame_count_;
    const std::string data = positions_->read(header_.data_offset + frame * frame_size, frame_size);
    const std::string place = member_name("V") + ": frame " + std::to_string(frame);
    return {decode_npy_points(header_, data, place), triangles_, groups_, precision()};
  }

 private:
  std::string member_name(const char* member) const { return name_ + "[" + member + "]"; }

  void open_positions(const ZipArchive& archive) {
    const std::string name = member_name("V");
    positions_ = archive.open("V.npy");
    header_ = parse_npy_header(positions_->read(0, kLongestNpyHeader), name);
    if (header_.data_size != positions_->size() - header_.data_offset) {
      bad_input(name, "the shape does not fit the size of the member; write the file again");
    }
    const std::vector<std::uint64_t>& shape = header_.shape;
    const bool is_one_frame = shape.size() == 2;
    if (header_.kind != NpyKind::kFloat || (!is_one_frame && shape.size() != 3) || shape.back() != 3) {
      bad_input(name, "not floats in the shape frames by #V by 3; save them so");
    }
    if (header_.fortran_order && !is_one_frame) {
      bad_input(name, "in Fortran order, where a frame is scattered over the file; save numpy.ascontiguousarray(V)");
    }
    const std::uint64_t rows = shape[shape.size() - 2];
    if (rows == 0 || rows > kMaxElements) bad_input(name, "no vertices, or more than 2^31 - 1; correct the shape");
    vertex_count_ = rows;
    frame_count_ = is_one_frame ? 1 : shape[0];
  }

  std::string name_;
  std::shared_ptr<const ByteSource> positions_;
  NpyHeader header_;
  std::size_t frame_count_ = 0, vertex_count_ = 0;
  Triangles triangles_;
  std::vector<Group> groups_;
};

}  // namespace

std::unique_ptr<SequenceReader> open_npz_sequence(std::shared_ptr<const ByteSource> source, std::string name) {
  return std::make_unique<NpzSequence>(std::move(source), std::move(name));
}

}  // namespace selvage::io
