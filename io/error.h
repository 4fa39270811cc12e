// What goes wrong with files, as one exception with the words for the user and the kind that decides the exit code.
#pragma once

#include <stdexcept>
#include <string>

namespace selvage::io {

enum class ErrorKind {
  kBadInput,  ///< the content is wrong: exit code 3
  kFile,      ///< the file cannot be opened, read, written or renamed: exit code 4
};

/// what() is one line: "FILE:LINE: what is wrong; what to do". LINE (or byte offset, or field) where there is one.
class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }

 private:
  ErrorKind kind_;
};

}  // namespace selvage::io
