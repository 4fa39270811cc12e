// Results as text on standard output, and as reports in files, which may be the same place.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace selvage::cli {

/// Whether one of the `reports` is what stdout goes to: whoever reads it there gets that report and nothing else.
[[nodiscard]] bool is_stdout_taken(const std::vector<std::filesystem::path>& reports);

/// Prints on stdout, or on stderr where that is taken by one of the `reports`.
void print_result(const std::string& text, const std::vector<std::filesystem::path>& reports);

/// io::write_atomically(), but what stdout goes to is written through stdout: a log that it is appended to keeps what
/// it held, and a pipe needs no name.
void write_report(const std::filesystem::path& file, std::string_view bytes);

}  // namespace selvage::cli
