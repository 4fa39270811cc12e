#include "io/atomic_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <random>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/fail.h"
#include "io/posix_file.h"

namespace selvage::io {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kTemporaryMark = ".tmp-";

/// Removes the temporary file unless it was renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target) : file_(create(target)) {}
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    if (!renamed_) ::unlink(file_.path().c_str());
  }

  PosixFile& file() { return file_; }
  void rename_to(const fs::path& target) {
    if (std::rename(file_.path().c_str(), target.c_str()) != 0) file_error(target.string(), "replace", errno);
    renamed_ = true;
  }

 private:
  /// Random and O_EXCL: process ids repeat between machines that share a file system.
  static PosixFile create(const fs::path& target) {
    std::random_device random;
    fs::path name = target;
    name += std::string(kTemporaryMark) + std::to_string((std::uint64_t{random()} << 32) | random());
    return {std::move(name), O_WRONLY | O_CREAT | O_EXCL};
  }

  PosixFile file_;
  bool renamed_ = false;
};

void write_in_place(const fs::path& file, std::string_view bytes) {
  PosixFile out(file, O_WRONLY);
  out.write(bytes);
  out.close();
}

}  // namespace

void write_atomically(const fs::path& file, std::string_view bytes) {
  std::error_code status;
  fs::path target = file;
  if (const fs::file_status found = fs::status(file, status); fs::exists(found)) {
    if (!fs::is_regular_file(found)) return write_in_place(file, bytes);
    target = fs::canonical(file, status);
    if (status) file_error(file.string(), "resolve", status.value());
  }
  TemporaryFile temporary(target);
  temporary.file().write(bytes);
  temporary.file().sync();
  temporary.file().close();
  temporary.rename_to(target);
  sync_folder(target.parent_path());
}

bool is_temporary_name(std::string_view name) {
  const std::size_t mark = name.rfind(kTemporaryMark);
  if (mark == std::string_view::npos || mark == 0) return false;
  const std::string_view number = name.substr(mark + kTemporaryMark.size());
  return !number.empty() && number.find_first_not_of("0123456789") == std::string_view::npos;
}

std::string read_file(const fs::path& file, std::size_t byte_limit) {
  const PosixFile in(file, O_RDONLY);
  struct stat status = {};
  if (::fstat(in.descriptor(), &status) != 0) file_error(file.string(), "inspect", errno);
  if (S_ISDIR(status.st_mode)) file_error(file.string(), "read", EISDIR);
  if (!S_ISREG(status.st_mode) && !S_ISFIFO(status.st_mode)) file_error(file.string(), "read a device", EINVAL);

  // The size is a hint: a pipe has none, and a file may grow while it is read.
  constexpr std::size_t kChunk = std::size_t{1} << 16;
  const auto hint = static_cast<std::size_t>(status.st_size);
  std::string bytes;
  for (std::size_t chunk = hint + 1; bytes.size() <= byte_limit && hint <= byte_limit;
       chunk = kChunk + bytes.size() / 2) {
    const std::size_t begin = bytes.size();
    bytes.resize(begin + chunk);
    const std::size_t got = in.read_some(bytes.data() + begin, chunk);
    bytes.resize(begin + got);
    if (got < chunk && bytes.size() <= byte_limit) return bytes;
  }
  bad_input(file.string(), "larger than " + std::to_string(byte_limit) + " bytes; split it");
}

}  // namespace selvage::io
