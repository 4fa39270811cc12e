#include "io/byte_source.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "io/file/posix_file.h"

namespace selvage::io {
namespace {

class FileSource final : public ByteSource {
 public:
  explicit FileSource(const std::filesystem::path& file) : file_(open_to_read(file)), size_(file_.size()) {}
  using ByteSource::read;
  std::uint64_t size() const override { return size_; }
  void read(std::uint64_t offset, char* bytes, std::size_t count) const override {
    file_.read_at(offset, bytes, count);
  }

 private:
  PosixFile file_;
  std::uint64_t size_;
};

class MemorySource final : public ByteSource {
 public:
  explicit MemorySource(std::string bytes) : bytes_(std::move(bytes)) {}
  using ByteSource::read;
  std::uint64_t size() const override { return bytes_.size(); }
  void read(std::uint64_t offset, char* bytes, std::size_t count) const override {
    std::memcpy(bytes, bytes_.data() + offset, count);
  }

 private:
  std::string bytes_;
};

class PieceSource final : public ByteSource {
 public:
  PieceSource(std::shared_ptr<const ByteSource> whole, std::uint64_t offset, std::uint64_t size)
      : whole_(std::move(whole)), offset_(offset), size_(size) {}
  using ByteSource::read;
  std::uint64_t size() const override { return size_; }
  void read(std::uint64_t offset, char* bytes, std::size_t count) const override {
    whole_->read(offset_ + offset, bytes, count);
  }

 private:
  std::shared_ptr<const ByteSource> whole_;
  std::uint64_t offset_, size_;
};

}  // namespace

std::string ByteSource::read(std::uint64_t offset, std::uint64_t count) const {
  if (offset >= size()) return {};  // a falsified offset may be so large that no pointer reaches it
  std::string bytes(std::min(count, size() - offset), '\0');
  read(offset, bytes.data(), bytes.size());
  return bytes;
}

std::shared_ptr<const ByteSource> open_file(const std::filesystem::path& file) {
  return std::make_shared<FileSource>(file);
}
std::shared_ptr<const ByteSource> in_memory(std::string bytes) {
  return std::make_shared<MemorySource>(std::move(bytes));
}
std::shared_ptr<const ByteSource> piece_of(std::shared_ptr<const ByteSource> whole, std::uint64_t offset,
                                           std::uint64_t size) {
  return std::make_shared<PieceSource>(std::move(whole), offset, size);
}

}  // namespace selvage::io
