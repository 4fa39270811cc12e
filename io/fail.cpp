#include "io/fail.h"

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace selvage::io {
namespace {

/// A path may hold any byte; a line break in it would break the rule of one line an error.
std::string one_line(std::string_view text) {
  std::string line(text);
  std::replace_if(
      line.begin(), line.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, '?');
  return line;
}

std::string_view remedy(int errno_value) {
  switch (errno_value) {
    case ENOENT:
    case ENOTDIR:
      return "check the path";
    case EACCES:
    case EPERM:
    case EROFS:
      return "check the permissions";
    case ENOSPC:
    case EDQUOT:
      return "free some space";
    case EFBIG:
      return "raise the limit on the size of files (ulimit -f)";
    case EISDIR:
      return "name a file";
    case ENAMETOOLONG:
      return "shorten the name";
    default:
      return "check the file system";
  }
}

}  // namespace

std::string in_quotes(std::string_view token) {
  constexpr std::size_t kLongest = 40;
  std::string text = "'";
  for (const char c : token.substr(0, kLongest)) text += c >= 0x20 && c < 0x7f ? c : '?';
  return text + (token.size() > kLongest ? "...'" : "'");
}

void bad_input(std::string_view name, std::string_view what) {
  throw Error(ErrorKind::kBadInput, one_line(name) + ": " + one_line(what));
}

void bad_input_at_line(std::string_view name, std::size_t line, std::string_view what) {
  throw Error(ErrorKind::kBadInput, one_line(name) + ":" + std::to_string(line) + ": " + one_line(what));
}

void bad_input_at_byte(std::string_view name, std::size_t offset, std::string_view what) {
  throw Error(ErrorKind::kBadInput, one_line(name) + ": byte " + std::to_string(offset) + ": " + one_line(what));
}

void file_error(std::string_view name, std::string_view action, int errno_value) {
  file_error(name, action, errno_value, remedy(errno_value));
}

void file_error(std::string_view name, std::string_view action, int errno_value, std::string_view remedy) {
  throw Error(ErrorKind::kFile, one_line(name) + ": cannot " + std::string(action) + ": " +
                                    std::generic_category().message(errno_value) + "; " + one_line(remedy));
}

}  // namespace selvage::io
