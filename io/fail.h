// The words of io::Error, always one printable line whatever the file holds.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "io/error.h"

namespace selvage::io {

/// Control characters and bytes outside ASCII become '?'; cut after 40 characters: a file's own text in an error.
[[nodiscard]] std::string in_quotes(std::string_view token);

/// Throws Error(kBadInput, "NAME: what"). `what` says what is wrong; then what to do.
[[noreturn]] void bad_input(std::string_view name, std::string_view what);
/// Throws Error(kBadInput, "NAME:LINE: what"), lines counted from 1.
[[noreturn]] void bad_input_at_line(std::string_view name, std::size_t line, std::string_view what);
/// Throws Error(kBadInput, "NAME: byte OFFSET: what"), bytes counted from 0.
[[noreturn]] void bad_input_at_byte(std::string_view name, std::size_t offset, std::string_view what);
/// Throws Error(kFile, "NAME: cannot ACTION: reason of errno_value; remedy").
[[noreturn]] void file_error(std::string_view name, std::string_view action, int errno_value);
/// The same with a remedy that the number alone does not give.
[[noreturn]] void file_error(std::string_view name, std::string_view action, int errno_value, std::string_view remedy);

}  // namespace selvage::io
