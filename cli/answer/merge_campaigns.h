// selvage merge, for the shards of selvage fuzz.
#pragma once

#include <filesystem>
#include <vector>

#include "cli/process/exit_code.h"

namespace selvage::cli {

/// Whether all of them are folders of campaigns. A mixture is left to whoever reads it next, as an error.
[[nodiscard]] bool are_campaigns(const std::vector<std::filesystem::path>& sources);
/// Joins the ledgers into the folder `output`, with the kept cases of all. Throws io::Error where shards are missing or
/// do not belong together. Exit code 1 where a promise broke.
[[nodiscard]] ExitCode merge_campaigns(const std::vector<std::filesystem::path>& sources,
                                       const std::filesystem::path& output);

}  // namespace selvage::cli
