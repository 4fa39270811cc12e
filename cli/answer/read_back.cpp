#include "cli/answer/read_back.h"

#include <string>
#include <string_view>
#include <utility>

#include "cli/arguments/sequence_decorator.h"
#include "io/file/checksum.h"

namespace selvage::cli {
namespace {

class ReadBack final : public SequenceDecorator {
 public:
  ReadBack(std::unique_ptr<io::SequenceReader> written, Claims claims, std::vector<std::uint32_t> checksums)
      : SequenceDecorator(std::move(written)), claims_(std::move(claims)), checksums_(std::move(checksums)) {
    if (inner().frame_count() == checksums_.size()) return;
    throw io::Error(io::ErrorKind::kFile, std::to_string(inner().frame_count()) + " frames are read back, " +
                                              std::to_string(checksums_.size()) + " were written; check the disk");
  }

  io::SequenceKind kind() const override { return claims_.kind; }
  const std::vector<io::Group>& groups() const override {
    return claims_.keeps_groups ? inner().groups() : claims_.groups;
  }

  io::MeshData frame(std::size_t frame) const override {
    io::MeshData mesh = inner().frame(frame);
    if (checksum(mesh.points) != checksums_.at(frame)) {
      throw io::Error(io::ErrorKind::kFile,
                      frame_name(frame) + ": what is read back is not what was written; check the disk");
    }
    if (!claims_.keeps_groups) mesh.groups = claims_.groups;
    return mesh;
  }

 private:
  Claims claims_;
  std::vector<std::uint32_t> checksums_;
};

}  // namespace

std::uint32_t checksum(const io::Points& points) {
  return io::crc32({reinterpret_cast<const char*>(points.data()), points.size() * sizeof points[0]});
}

std::unique_ptr<io::SequenceReader> read_back(std::unique_ptr<io::SequenceReader> written, Claims claims,
                                              std::vector<std::uint32_t> checksums) {
  return std::make_unique<ReadBack>(std::move(written), std::move(claims), std::move(checksums));
}

}  // namespace selvage::cli
