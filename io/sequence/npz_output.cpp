// Writes .npz as numpy.savez does: members stored, always with the 64-bit sizes of ZIP64, so that one layout serves
// files of any size. The checksum of a member is known behind its data and is put into the header before them then.
// Source: PKWARE, APPNOTE, sections 4.3.7 (local header), 4.3.12 (directory), 4.3.14 to 4.3.16 (its ends), 4.5.3.
#include <utility>

#include "io/fail.h"
#include "io/file/atomic_file.h"
#include "io/file/byte_order.h"
#include "io/file/checksum.h"
#include "io/format/npy.h"
#include "io/points.h"
#include "io/sequence/sequence_outputs.h"
#include "io/sequence/sequence_readers.h"

namespace selvage::io {
namespace fs = std::filesystem;
namespace {

void put16(std::string& bytes, std::uint16_t value) { append(bytes, value, std::endian::little); }
void put32(std::string& bytes, std::uint32_t value) { append(bytes, value, std::endian::little); }
void put64(std::string& bytes, std::uint64_t value) { append(bytes, value, std::endian::little); }

constexpr std::uint16_t kZip64Version = 45, kZip64Field = 1, kStored = 0;
constexpr std::uint16_t kTime = 0,
                        kDate = 1 << 5 | 1;  // 1980-01-01, the first that zip can say: same input, same bytes
constexpr std::uint32_t kFull = 0xffffffff;  // "see the 64-bit field"
constexpr std::uint64_t kLocalSize = 30, kCrcAt = 14, kSizesAt = 4;  // of the header; within the 64-bit field

struct Member {
  std::string name;
  std::uint32_t crc32 = 0;
  std::uint64_t size = 0, header_offset = 0;
};

/// What local header and directory entry have in common, from the version to the length of the name.
std::string common_fields(const Member& member, std::uint16_t extra_size) {
  std::string bytes;
  put16(bytes, kZip64Version);
  put16(bytes, 0);  // flags
  put16(bytes, kStored);
  put16(bytes, kTime);
  put16(bytes, kDate);
  put32(bytes, member.crc32);
  put32(bytes, kFull);
  put32(bytes, kFull);
  put16(bytes, static_cast<std::uint16_t>(member.name.size()));
  put16(bytes, extra_size);
  return bytes;
}

class ZipWriter {
 public:
  explicit ZipWriter(fs::path target) : file_(std::move(target)) {}

  void begin(std::string name) {
    constexpr std::uint16_t kExtraSize = kSizesAt + 16;
    members_.push_back({.name = std::move(name), .header_offset = position_});
    std::string bytes = "PK\x03\x04" + common_fields(members_.back(), kExtraSize) + members_.back().name;
    put16(bytes, kZip64Field);
    put16(bytes, kExtraSize - kSizesAt);
    put64(bytes, 0);
    put64(bytes, 0);
    put(bytes);
  }
  void write(std::string_view bytes) {
    Member& member = members_.back();
    member.crc32 = crc32(bytes, member.crc32);
    member.size += bytes.size();
    put(bytes);
  }
  void end() {
    const Member& member = members_.back();
    std::string sum, sizes;
    put32(sum, member.crc32);
    put64(sizes, member.size);
    put64(sizes, member.size);
    file_.overwrite(member.header_offset + kCrcAt, sum);
    file_.overwrite(member.header_offset + kLocalSize + member.name.size() + kSizesAt, sizes);
  }

  void commit() {
    const std::uint64_t directory = position_;
    for (const Member& member : members_) put(directory_entry(member));
    put(ends(directory, position_ - directory));
    file_.commit_new();
  }
  const fs::path& target() const { return file_.target(); }

 private:
  static std::string directory_entry(const Member& member) {
    constexpr std::uint16_t kExtraSize = kSizesAt + 24;
    std::string bytes = "PK\x01\x02";
    put16(bytes, kZip64Version);
    bytes += common_fields(member, kExtraSize);
    put16(bytes, 0);      // comment
    put16(bytes, 0);      // disk
    put16(bytes, 0);      // internal attributes
    put32(bytes, 0);      // external attributes
    put32(bytes, kFull);  // offset
    bytes += member.name;
    put16(bytes, kZip64Field);
    put16(bytes, kExtraSize - kSizesAt);
    put64(bytes, member.size);
    put64(bytes, member.size);
    put64(bytes, member.header_offset);
    return bytes;
  }

  std::string ends(std::uint64_t directory, std::uint64_t directory_size) const {
    std::string bytes = "PK\x06\x06";
    put64(bytes, 44);  // of the rest of this record
    put16(bytes, kZip64Version);
    put16(bytes, kZip64Version);
    put32(bytes, 0);  // disks
    put32(bytes, 0);
    put64(bytes, members_.size());
    put64(bytes, members_.size());
    put64(bytes, directory_size);
    put64(bytes, directory);
    bytes += "PK\x06\x07";
    put32(bytes, 0);
    put64(bytes, directory + directory_size);
    put32(bytes, 1);  // disks
    bytes += "PK\x05\x06";
    put16(bytes, 0);
    put16(bytes, 0);
    put16(bytes, static_cast<std::uint16_t>(members_.size()));
    put16(bytes, static_cast<std::uint16_t>(members_.size()));
    put32(bytes, kFull);
    put32(bytes, kFull);
    put16(bytes, 0);  // comment
    return bytes;
  }

  void put(std::string_view bytes) {
    file_.write(bytes);
    position_ += bytes.size();
  }

  AtomicFile file_;
  std::uint64_t position_ = 0;
  std::vector<Member> members_;
};

class NpzOutput final : public SequenceOutput {
 public:
  NpzOutput(fs::path file, OutputHeader all) : SequenceOutput(std::move(file), std::move(all)), zip_(target()) {
    const auto& [sequence, vertex_count, frame_count] = header();
    require_absent(target());
    const std::string roles = role_bytes(sequence.triangles.size(), sequence.groups);
    require_readable(roles);
    zip_.begin("F.npy");
    zip_.write(npy_bytes(sequence.triangles));
    zip_.end();
    if (!sequence.groups.empty()) {
      zip_.begin("group.npy");
      zip_.write(npy_start("|u1", {sequence.triangles.size()}));
      zip_.write(roles);
      zip_.end();
    }
    zip_.begin("V.npy");
    zip_.write(npy_start(npy_type(sequence.precision), {frame_count, vertex_count, 3}));
  }
  std::vector<fs::path> sources() const override { return {target()}; }

 private:
  /// What the reader would refuse is refused here, while the input is still there.
  void require_readable(const std::string& roles) const {
    std::size_t groups = 1;
    for (std::size_t face = 1; face < roles.size(); ++face) groups += roles[face] != roles[face - 1] ? 1 : 0;
    if (groups <= kMaxNpzGroups) return;
    bad_input(target().string(), "cloth and bodies alternate " + std::to_string(groups) +
                                     " times over the faces, which no .npz holds (4,096 at most); write a folder, or " +
                                     "sort the faces by group");
  }
  void write_frame(double, const MeshData& mesh) override {
    require_same_mesh(header(), mesh, OutputFormat::kNpz, target());
    std::string bytes;
    append_points(bytes, mesh.points, header().sequence.precision, target().string());
    zip_.write(bytes);
  }
  void commit() override {
    zip_.end();
    zip_.commit();
  }

  ZipWriter zip_;
};

}  // namespace

std::unique_ptr<SequenceOutput> create_npz_output(fs::path target, OutputHeader header) {
  return std::make_unique<NpzOutput>(std::move(target), std::move(header));
}

}  // namespace selvage::io
