// The files that a bench writes beside its tables.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace selvage::cli {

struct BenchOutputs {
  std::string json, svg;  ///< empty: not asked for

  /// For the checks before the work, and for print_result().
  [[nodiscard]] std::vector<std::filesystem::path> files() const { return {json, svg}; }
};

/// Adds --json and --svg.
void add_outputs(CLI::App& bench, BenchOutputs& outputs);

}  // namespace selvage::cli
