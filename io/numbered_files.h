// Mesh files that are numbered, one a frame, by the pattern of their names.
#pragma once

#include <filesystem>
#include <vector>

#include "io/error.h"

namespace selvage::io {

/// The files whose names are that of `pattern` with digits in place of its one `*`, in the order of these numbers;
/// `pattern` itself where there is no `*`. Throws Error where there is no such file, two have the same number, or the
/// numbers do not go up by one step, which would not be missed: with the name of the file that is missing; or where a
/// number has a sign, a fraction or more than 18 digits.
[[nodiscard]] std::vector<std::filesystem::path> numbered_files(const std::filesystem::path& pattern);

}  // namespace selvage::io
