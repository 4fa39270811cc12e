// Files that are either whole or absent: temporary file, fsync, rename, fsync of the folder.
#pragma once

#include <filesystem>
#include <string_view>

#include "io/error.h"

namespace selvage::io {

/// Replaces `file` by `bytes`. On failure throws Error(kFile) and leaves the old file intact.
void write_atomically(const std::filesystem::path& file, std::string_view bytes);
/// The whole file. Throws Error(kFile); Error(kBadInput) above `byte_limit`.
[[nodiscard]] std::string read_file(const std::filesystem::path& file, std::size_t byte_limit = std::size_t{1} << 36);

}  // namespace selvage::io
