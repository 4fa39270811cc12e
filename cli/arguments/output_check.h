// What is known of outputs before the work: none may take the place of what the same command reads or writes, where the
// damage would show only later, and each can be written.
#pragma once

#include <filesystem>
#include <vector>

namespace selvage::cli {

/// Also of two names under which there is nothing yet; links are followed.
[[nodiscard]] bool is_one_file(const std::filesystem::path& a, const std::filesystem::path& b);

/// Throws UsageError where an output is one of the inputs, or two outputs are one file, whatever their names: links are
/// followed; or where an output is a mesh, scene or query file that is there, or a part of a sequence. Empty outputs
/// were not asked for. Devices and pipes hold nothing that could be lost. Nor is one "-", which elsewhere is standard
/// output. Throws io::Error where a name is longer than any file's.
void require_separate_outputs(const std::vector<std::filesystem::path>& inputs,
                              const std::vector<std::filesystem::path>& outputs);

/// Throws UsageError where `output` is "-".
void require_no_dash(const std::filesystem::path& output);

/// Whether `file` is what stdout goes to, a file or a pipe: /dev/stdout, or the name that the shell was given. What is
/// written to a terminal or to /dev/null is read by no program.
[[nodiscard]] bool is_standard_output(const std::filesystem::path& file);

/// Throws UsageError where `output` is the name of what is no folder: "-", or a file of a sequence; io::Error where a
/// name is longer than any file's.
void require_folder_name(const std::filesystem::path& output);

/// Throws io::Error where one of them could not be written now: better before long work than after it. Leaves nothing.
void require_writable(const std::vector<std::filesystem::path>& outputs);

/// Both, for reports in folders that are there: require_separate_outputs() and require_writable().
void require_outputs(const std::vector<std::filesystem::path>& inputs,
                     const std::vector<std::filesystem::path>& outputs);

}  // namespace selvage::cli
