// A POSIX file that is always closed, with every return value checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>

#include "io/error.h"

namespace selvage::io {

/// Owns a descriptor. Every function throws Error(kFile) with its name when the system call fails.
class PosixFile {
 public:
  /// `flags` and `mode` as for open(2); O_CLOEXEC is added.
  PosixFile(const std::filesystem::path& path, int flags, unsigned mode = 0666) : PosixFile(path, path, flags, mode) {}
  /// Errors speak of `name`: what the user knows of, where `path` is only on the way there.
  PosixFile(std::filesystem::path path, std::filesystem::path name, int flags, unsigned mode = 0666);
  PosixFile(PosixFile&& other) noexcept;
  PosixFile& operator=(PosixFile&& other) noexcept;
  ~PosixFile();

  [[nodiscard]] int descriptor() const { return descriptor_; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Bytes in it now.
  [[nodiscard]] std::uint64_t size() const;
  /// Up to `count` bytes from the current position; less only at the end of the file.
  [[nodiscard]] std::size_t read_some(char* bytes, std::size_t count) const;
  /// Exactly `count` bytes from `offset`; may be called from several threads.
  void read_at(std::uint64_t offset, char* bytes, std::size_t count) const;
  void write(std::string_view bytes) const;
  /// At `offset`, wherever the current position is.
  void write_at(std::uint64_t offset, std::string_view bytes) const;
  /// On disk when it returns: fsync.
  void sync() const;
  /// Reports what close(2) says; the destructor cannot.
  void close();

 private:
  std::filesystem::path path_, name_;
  int descriptor_ = -1;
};

/// The one way in which files are opened for reading. Throws Error(kFile) for what is no regular file, without waiting
/// for the other end of a pipe: a pipe can be read only once, and a device may have no end.
[[nodiscard]] PosixFile open_to_read(const std::filesystem::path& file);

/// Makes the names in `folder` durable: a rename is on disk only after this.
void sync_folder(const std::filesystem::path& folder);

}  // namespace selvage::io
