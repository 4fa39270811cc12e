#include "io/file/posix_file.h"

#include <cerrno>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/fail.h"

namespace selvage::io {

PosixFile::PosixFile(std::filesystem::path path, std::filesystem::path name, int flags, unsigned mode)
    : path_(std::move(path)), name_(std::move(name)) {
  do {
    descriptor_ = ::open(path_.c_str(), flags | O_CLOEXEC, mode);
  } while (descriptor_ < 0 && errno == EINTR);
  if (descriptor_ < 0) file_error(name_.string(), "open", errno);
}

PosixFile::PosixFile(PosixFile&& other) noexcept
    : path_(std::move(other.path_)), name_(std::move(other.name_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

PosixFile& PosixFile::operator=(PosixFile&& other) noexcept {
  std::swap(path_, other.path_);
  std::swap(name_, other.name_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

PosixFile::~PosixFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

std::uint64_t PosixFile::size() const {
  struct stat status = {};
  if (::fstat(descriptor_, &status) != 0) file_error(name_.string(), "inspect", errno);
  return static_cast<std::uint64_t>(status.st_size);
}

std::size_t PosixFile::read_some(char* bytes, std::size_t count) const {
  std::size_t done = 0;
  while (done < count) {
    const ssize_t got = ::read(descriptor_, bytes + done, count - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) file_error(name_.string(), "read", errno);
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  return done;
}

void PosixFile::read_at(std::uint64_t offset, char* bytes, std::size_t count) const {
  while (count > 0) {
    const ssize_t got = ::pread(descriptor_, bytes, count, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) file_error(name_.string(), "read", errno);
    if (got == 0) bad_input(name_.string(), "truncated while it was read; copy it again");
    offset += static_cast<std::uint64_t>(got);
    bytes += got;
    count -= static_cast<std::size_t>(got);
  }
}

void PosixFile::write(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t put = ::write(descriptor_, bytes.data(), bytes.size());
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) file_error(name_.string(), "write", errno);
    bytes.remove_prefix(static_cast<std::size_t>(put));
  }
}

void PosixFile::write_at(std::uint64_t offset, std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t put = ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) file_error(name_.string(), "write", errno);
    offset += static_cast<std::uint64_t>(put);
    bytes.remove_prefix(static_cast<std::size_t>(put));
  }
}

void PosixFile::sync() const {
  if (::fsync(descriptor_) != 0) file_error(name_.string(), "sync", errno);
}

void PosixFile::close() {
  if (::close(std::exchange(descriptor_, -1)) != 0) file_error(name_.string(), "close", errno);
}

PosixFile open_to_read(const std::filesystem::path& file) {
  PosixFile in(file, O_RDONLY | O_NONBLOCK);
  struct stat status = {};
  if (::fstat(in.descriptor(), &status) != 0) file_error(file.string(), "inspect", errno);
  if (S_ISDIR(status.st_mode)) file_error(file.string(), "read", EISDIR);
  if (!S_ISREG(status.st_mode)) {
    throw Error(ErrorKind::kFile,
                file.string() + ": a pipe or a device, not a file; write it to a file first, and name that");
  }
  return in;
}

void sync_folder(const std::filesystem::path& folder) {
  const PosixFile handle(folder.empty() ? "." : folder, O_RDONLY | O_DIRECTORY);
  // Some network file systems cannot sync a folder and say EINVAL; their renames are as durable as they get.
  if (::fsync(handle.descriptor()) != 0 && errno != EINVAL) file_error(handle.path().string(), "sync", errno);
}

}  // namespace selvage::io
