// Formats are told by the extension of the file.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>

namespace selvage::io {

/// Whether `file` ends in `extension` (".obj", given in lower case), in any case: some programs write .OBJ.
[[nodiscard]] inline bool has_extension(const std::filesystem::path& file, std::string_view extension) {
  std::string found = file.extension().string();
  std::transform(found.begin(), found.end(), found.begin(),
                 [](char c) { return 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return found == extension;
}

}  // namespace selvage::io
