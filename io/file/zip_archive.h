// Reads zip archives as numpy writes them: members stored or deflated, ZIP64; nothing encrypted, nothing split.
// Source: PKWARE, ".ZIP File Format Specification" (APPNOTE), sections 4.3 and 4.5.3.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/byte_source.h"
#include "io/error.h"

namespace selvage::io {

struct ZipMember {
  std::string name;
  bool is_deflated = false;
  std::uint32_t crc32 = 0;
  std::uint64_t compressed_size = 0, size = 0;
  std::uint64_t header_offset = 0;
};

class ZipArchive {
 public:
  /// Reads the directory at the end. Throws Error. `name` appears in errors.
  ZipArchive(std::shared_ptr<const ByteSource> source, std::string name);

  [[nodiscard]] bool contains(std::string_view member_name) const;
  /// The content of a member; its checksum is verified here, in one pass. A stored member stays where it is; a deflated
  /// one is inflated into memory, up to kInflatedMinimum or kInflatedFactor times the archive, whichever is more.
  /// Throws Error: no such member, or two, damage, or sizes that are not true.
  [[nodiscard]] std::shared_ptr<const ByteSource> open(std::string_view member_name) const;

  /// Frames at rest of a small mesh fit in deflate's window and shrink a thousandfold (its limit is 1032), so that a
  /// small archive may be honest at any factor; a large one is then a bomb.
  static constexpr std::uint64_t kInflatedMinimum = std::uint64_t{1} << 28, kInflatedFactor = 64;

 private:
  void read_directory(std::uint64_t offset, std::uint64_t size, std::uint64_t count);
  [[nodiscard]] const ZipMember& find(std::string_view member_name) const;
  [[nodiscard]] std::uint64_t data_offset(const ZipMember& member) const;
  [[nodiscard]] std::string inflate(const ZipMember& member, std::uint64_t offset) const;

  std::shared_ptr<const ByteSource> source_;
  std::string name_;
  std::uint64_t directory_offset_ = 0;  ///< no member reaches beyond
  std::vector<ZipMember> members_;
};

}  // namespace selvage::io
