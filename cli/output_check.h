// No output may take the place of what the same command reads or writes: the damage would show only later.
#pragma once

#include <filesystem>
#include <vector>

namespace selvage::cli {

/// Throws UsageError where an output is one of the inputs, or two outputs are one file, whatever their names: links are
/// followed. Empty outputs were not asked for. Devices and pipes hold nothing that could be lost.
void require_separate_outputs(const std::vector<std::filesystem::path>& inputs,
                              const std::vector<std::filesystem::path>& outputs);

}  // namespace selvage::cli
