// The conformance report of `selvage fuzz --plugin` as a page to look at.
#pragma once

#include <filesystem>
#include <string>

#include "fuzz/plugin/conformance.h"

namespace selvage::cli {

struct ConformanceRun {
  std::string program;            ///< name and version
  std::filesystem::path library;  ///< the plugin
  std::filesystem::path folder;   ///< of the campaign: kept cases are read from it
  bool is_finished = true;        ///< not interrupted
};

/// One HTML file without scripts: the verdict, the smallest counterexample of each kind of failure, a table of all
/// classes, and every finding with its first case, its smallest one as hex floats, and the commands that show them
/// again. Throws io::Error where a kept case cannot be read.
[[nodiscard]] std::string conformance_page(const fuzz::Ledger& ledger, const fuzz::Property& property,
                                           const fuzz::PluginInfo& info, const ConformanceRun& run);

}  // namespace selvage::cli
