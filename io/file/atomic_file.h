// Files that are either whole or absent: temporary file, fsync, rename, fsync of the folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "io/error.h"
#include "io/file/posix_file.h"

namespace selvage::io {

/// A file that is written piece by piece and appears whole, by commit(), or not at all. Every call throws Error(kFile)
/// where the system fails.
class AtomicFile {
 public:
  /// Opens a temporary file "NAME.tmp-..." beside `target`, of a long NAME what fits; a kill leaves at most that.
  explicit AtomicFile(std::filesystem::path target);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();  ///< removes it, unless it was committed

  [[nodiscard]] const std::filesystem::path& target() const { return target_; }
  void write(std::string_view bytes) { file_.write(bytes); }
  /// Replaces bytes that were written already.
  void overwrite(std::uint64_t offset, std::string_view bytes) { file_.write_at(offset, bytes); }
  /// Of the file that is to be replaced, before anything is written: what was made private is at no time readable by
  /// others. A file system that has none is no error.
  void take_permissions(std::filesystem::perms permissions) const;
  /// Replaces the target; on disk when it returns.
  void commit();
  /// As commit(), but in nothing's place: throws Error(kFile) where something has the target's name by then, which
  /// stays.
  void commit_new();

 private:
  std::filesystem::path target_;
  PosixFile file_;
  bool is_committed_ = false;
};

/// What `file` names behind links, whether it is there or not: what would be written. Throws Error(kFile) where links
/// lead round in a circle.
[[nodiscard]] std::filesystem::path behind_links(const std::filesystem::path& file);

/// Whether there may be files of that name, which is no path: at most NAME_MAX bytes.
[[nodiscard]] bool is_nameable(const std::filesystem::path& name);

/// Throws Error(kFile) where the name of `file`, or of a folder in its path, is longer than any that there are
/// (NAME_MAX): to be called before work whose result would have that name.
void require_nameable(const std::filesystem::path& file);

/// Throws Error(kFile) if `file` is there, or can have no such name.
void require_absent(const std::filesystem::path& file);

/// Replaces `file` by `bytes`, with the permissions of the file that was there; on disk when it returns. On failure
/// throws Error(kFile) and leaves the old file intact. A kill leaves at most a file "NAME.tmp-..." beside it. A link is
/// followed, to what is not there yet as well. What is no regular file (a pipe, a device) cannot be replaced and is
/// written in place.
void write_atomically(const std::filesystem::path& file, std::string_view bytes);

/// Whether `name` is what a killed write_atomically("NAME") leaves behind.
[[nodiscard]] bool is_temporary_name(std::string_view name);

/// The whole file, opened by open_to_read(). Throws Error(kFile); Error(kBadInput) above `byte_limit`.
[[nodiscard]] std::string read_file(const std::filesystem::path& file, std::size_t byte_limit = std::size_t{1} << 36);

}  // namespace selvage::io
