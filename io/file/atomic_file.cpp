#include "io/file/atomic_file.h"

#include <algorithm>
#include <cerrno>
#include <climits>
#include <cstdint>
#include <cstdio>
#include <random>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "io/fail.h"

namespace selvage::io {
namespace fs = std::filesystem;
namespace {

constexpr std::string_view kTemporaryMark = ".tmp-";

/// Why nothing can be created in the folder, or 0: by the rights that the process has, not by those of who started it.
int refused_by(const fs::path& folder) {
  if (::faccessat(AT_FDCWD, folder.c_str(), W_OK | X_OK, AT_EACCESS) == 0) return 0;
  return errno == EACCES || errno == EPERM || errno == EROFS ? errno : 0;
}

/// Random and O_EXCL: process ids repeat between machines that share a file system. Where the folder refuses, the error
/// says so: of a file that may be written nobody would look there.
PosixFile create_temporary(const fs::path& target) {
  std::random_device random;
  const std::string mark = std::string(kTemporaryMark) + std::to_string((std::uint64_t{random()} << 32) | random());
  const std::string name = target.filename().string().substr(0, NAME_MAX - mark.size());
  fs::path temporary = target.parent_path() / (name + mark);
  try {
    return {std::move(temporary), target, O_WRONLY | O_CREAT | O_EXCL};
  } catch (const Error&) {
    const fs::path folder = target.has_parent_path() ? target.parent_path() : ".";
    const int reason = refused_by(folder);
    if (reason == 0) throw;
    file_error(target.string(), "write in its folder", reason,
               "check the permissions of " + folder.string() +
                   ", where a new file is written first, which then takes this name");
  }
}

[[noreturn]] void fail_as_present(const fs::path& file) {
  throw Error(ErrorKind::kFile, file.string() + ": is there already; remove it, or choose another name");
}

/// rename(2), or EEXIST where something is called `to`.
int rename_to_new(const char* from, const char* to) {
  if (::renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_NOREPLACE) == 0) return 0;
  if (errno != EINVAL && errno != ENOSYS) return -1;
  if (::link(from, to) == 0) {  // which NFS can
    ::unlink(from);
    return 0;
  }
  if (errno == EEXIST) return -1;
  struct stat present = {};
  if (::lstat(to, &present) != 0)
    return std::rename(from, to);  // between the two a file may appear: nothing better is left
  errno = EEXIST;
  return -1;
}

void write_in_place(const fs::path& file, std::string_view bytes) {
  PosixFile out(file, O_WRONLY);
  out.write(bytes);
  out.close();
}

}  // namespace

AtomicFile::AtomicFile(fs::path target) : target_(std::move(target)), file_(create_temporary(target_)) {}

AtomicFile::~AtomicFile() {
  if (!is_committed_) ::unlink(file_.path().c_str());
}

void AtomicFile::take_permissions(fs::perms permissions) const {
  (void)::fchmod(file_.descriptor(), static_cast<mode_t>(permissions & fs::perms::all));
}

void AtomicFile::commit() {
  file_.sync();
  file_.close();
  if (std::rename(file_.path().c_str(), target_.c_str()) != 0) file_error(target_.string(), "replace", errno);
  is_committed_ = true;
  sync_folder(target_.parent_path());
}

void AtomicFile::commit_new() {
  file_.sync();
  file_.close();
  if (rename_to_new(file_.path().c_str(), target_.c_str()) != 0) {
    if (errno == EEXIST) fail_as_present(target_);
    file_error(target_.string(), "create", errno);
  }
  is_committed_ = true;
  try {
    sync_folder(target_.parent_path());
  } catch (const Error&) {
    ::unlink(target_.c_str());  // nobody hears of it
    throw;
  }
}

fs::path behind_links(const fs::path& file) {
  constexpr int kMaxLinks = 40;  // as many as Linux follows
  std::error_code status;
  fs::path target = file;
  for (int links = 0; fs::is_symlink(fs::symlink_status(target, status)); ++links) {
    if (links == kMaxLinks) file_error(file.string(), "resolve", ELOOP);
    const fs::path next = fs::read_symlink(target, status);
    if (status) file_error(target.string(), "resolve", status.value());
    target = target.parent_path() / next;  // the link alone where that is absolute
  }
  return target;
}

bool is_nameable(const fs::path& name) { return name.native().size() <= NAME_MAX; }

void require_nameable(const fs::path& file) {
  for (const fs::path& name : file) {
    if (!is_nameable(name)) file_error(file.string(), "write", ENAMETOOLONG);
  }
}

void require_absent(const fs::path& file) {
  require_nameable(file);
  std::error_code status;
  if (fs::exists(fs::symlink_status(file, status))) fail_as_present(file);
}

void write_atomically(const fs::path& file, std::string_view bytes) {
  std::error_code status;
  const fs::file_status found = fs::status(file, status);
  if (fs::exists(found) && !fs::is_regular_file(found)) return write_in_place(file, bytes);
  AtomicFile temporary(behind_links(file));
  if (fs::exists(found)) temporary.take_permissions(found.permissions());
  temporary.write(bytes);
  temporary.commit();
}

bool is_temporary_name(std::string_view name) {
  const std::size_t mark = name.rfind(kTemporaryMark);
  if (mark == std::string_view::npos || mark == 0) return false;
  const std::string_view number = name.substr(mark + kTemporaryMark.size());
  return !number.empty() && number.find_first_not_of("0123456789") == std::string_view::npos;
}

std::string read_file(const fs::path& file, std::size_t byte_limit) {
  const PosixFile in = open_to_read(file);
  // The size is a hint: a file may grow while it is read.
  constexpr std::size_t kChunk = std::size_t{1} << 16;
  const auto hint = static_cast<std::size_t>(in.size());
  std::string bytes;
  for (std::size_t chunk = hint + 1; bytes.size() <= byte_limit && hint <= byte_limit;
       chunk = kChunk + bytes.size() / 2) {
    const std::size_t begin = bytes.size();
    bytes.resize(begin + chunk);
    const std::size_t got = in.read_some(bytes.data() + begin, chunk);
    bytes.resize(begin + got);
    if (got < chunk && bytes.size() <= byte_limit) return bytes;
  }
  bad_input(file.string(), "larger than " + std::to_string(byte_limit) + " bytes; shorten or split it");
}

}  // namespace selvage::io
