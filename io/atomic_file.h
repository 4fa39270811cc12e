// Files that are either whole or absent: temporary file, fsync, rename, fsync of the folder.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "io/error.h"

namespace selvage::io {

/// Replaces `file` by `bytes`; on disk when it returns. On failure throws Error(kFile) and leaves the old file intact.
/// A kill leaves at most a file "NAME.tmp-..." beside it. A link is followed. What is no regular file (a pipe, a
/// device) cannot be replaced and is written in place.
void write_atomically(const std::filesystem::path& file, std::string_view bytes);

/// Whether `name` is what a killed write_atomically("NAME") leaves behind.
[[nodiscard]] bool is_temporary_name(std::string_view name);

/// The whole file (or pipe). Throws Error(kFile); Error(kBadInput) above `byte_limit`. Devices are refused: they may
/// have no end.
[[nodiscard]] std::string read_file(const std::filesystem::path& file, std::size_t byte_limit = std::size_t{1} << 36);

}  // namespace selvage::io
