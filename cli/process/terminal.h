// What is said on stderr: notes, and progress where a person watches.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace selvage::cli {

/// Whether `descriptor` (1 stdout, 2 stderr) is a terminal that understands control sequences.
[[nodiscard]] bool is_terminal(int descriptor);
/// Whether to colour text on `descriptor`: a terminal, and NO_COLOR is unset or empty.
[[nodiscard]] bool use_colour(int descriptor);

/// Writes to stderr. Where that cannot be written to (closed, its disk full) nothing is said and nothing stops:
/// verdicts and files go elsewhere.
void say_text(const std::string& text);
template <class... Values>
void say(fmt::format_string<Values...> format, Values&&... values) {
  say_text(fmt::format(format, std::forward<Values>(values)...));
}

/// On stderr, a line each, whatever names of files are in them: what a user should know and what is no error.
void print_notes(const std::vector<std::string>& notes);

/// One line on stderr that overwrites itself, at most ten times a second; nothing at all if stderr is no terminal.
class ProgressBar {
 public:
  explicit ProgressBar(std::string label);
  ~ProgressBar();  ///< clears the line
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  void update(std::size_t done, std::size_t total);

 private:
  std::string label_;
  bool enabled_;
  bool drawn_ = false;
  std::chrono::steady_clock::time_point last_{};
};

}  // namespace selvage::cli
