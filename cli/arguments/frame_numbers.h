// Mesh files of a sequence are named one by one, mostly by a pattern of the shell, and those of a folder in its list: a
// file that is missing is not missed.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace selvage::cli {

/// Where the numbers in the names do not go up by the smallest of their steps: one line that names the first place.
/// Nothing where they do, or where the names are not one pattern in which one number changes.
[[nodiscard]] std::optional<std::string> jump_in_numbers(const std::vector<std::filesystem::path>& files);

}  // namespace selvage::cli
