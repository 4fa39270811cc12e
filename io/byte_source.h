// Bytes that are read where they are needed: a file, a piece of one, or memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "io/error.h"

namespace selvage::io {

/// read() may be called from several threads.
class ByteSource {
 public:
  virtual ~ByteSource() = default;
  [[nodiscard]] virtual std::uint64_t size() const = 0;
  /// REQUIRES offset + count <= size(). Throws Error.
  virtual void read(std::uint64_t offset, char* bytes, std::size_t count) const = 0;

  /// `count` bytes from `offset`, fewer at the end.
  [[nodiscard]] std::string read(std::uint64_t offset, std::uint64_t count) const;
};

[[nodiscard]] std::shared_ptr<const ByteSource> open_file(const std::filesystem::path& file);
[[nodiscard]] std::shared_ptr<const ByteSource> in_memory(std::string bytes);
/// REQUIRES offset + size <= whole->size().
[[nodiscard]] std::shared_ptr<const ByteSource> piece_of(std::shared_ptr<const ByteSource> whole, std::uint64_t offset,
                                                         std::uint64_t size);

}  // namespace selvage::io
