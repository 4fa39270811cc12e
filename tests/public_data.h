// Where the public query sets and sequences are, for the tests that use them; the others do not need them.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace selvage::testing {

/// The environment variable SELVAGE_DATA, else ../shared/data beside the source tree; nothing where neither exists.
inline std::optional<std::filesystem::path> public_data() {
  const char* named = std::getenv("SELVAGE_DATA");
  const std::filesystem::path folder = named != nullptr ? named : SELVAGE_SOURCE_DIR "/../shared/data";
  if (std::filesystem::is_directory(folder)) return folder;
  return std::nullopt;
}

}  // namespace selvage::testing
