#include "cli/answer/result.h"

#include <algorithm>
#include <cstdio>

#include "cli/arguments/output_check.h"
#include "cli/process/terminal.h"
#include "io/file/atomic_file.h"

namespace selvage::cli {
namespace {

/// What is lost is seen when the program ends.
void write_to_stdout(std::string_view bytes) { std::fwrite(bytes.data(), 1, bytes.size(), stdout); }

}  // namespace

bool is_stdout_taken(const std::vector<std::filesystem::path>& reports) {
  return std::ranges::any_of(reports, is_standard_output);
}

void print_result(const std::string& text, const std::vector<std::filesystem::path>& reports) {
  if (is_stdout_taken(reports)) {
    say_text(text);
  } else {
    write_to_stdout(text);
  }
}

void write_report(const std::filesystem::path& file, std::string_view bytes) {
  if (is_standard_output(file)) {
    write_to_stdout(bytes);
  } else {
    io::write_atomically(file, bytes);
  }
}

}  // namespace selvage::cli
