#include "cli/process/terminal.h"

#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "io/file/text.h"

namespace selvage::cli {
namespace {

std::string_view environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string_view{} : std::string_view{value};
}

constexpr const char* kClearLine = "\r\033[K";

}  // namespace

bool is_terminal(int descriptor) { return isatty(descriptor) == 1 && environment("TERM") != "dumb"; }

bool use_colour(int descriptor) { return is_terminal(descriptor) && environment("NO_COLOR").empty(); }

void say_text(const std::string& text) { std::fputs(text.c_str(), stderr); }

void print_notes(const std::vector<std::string>& notes) {
  for (const std::string& note : notes) say("selvage: note: {}\n", io::printable(note));
}

ProgressBar::ProgressBar(std::string label) : label_(std::move(label)), enabled_(is_terminal(STDERR_FILENO)) {}

ProgressBar::~ProgressBar() {
  if (drawn_) std::fputs(kClearLine, stderr);
}

void ProgressBar::update(std::size_t done, std::size_t total) {
  constexpr std::chrono::milliseconds kInterval{100};
  constexpr std::size_t kWidth = 30;
  if (!enabled_ || total == 0) return;
  const auto now = std::chrono::steady_clock::now();
  if (drawn_ && now - last_ < kInterval) return;
  last_ = now;
  drawn_ = true;
  const std::string bar(done * kWidth / total, '#');
  std::fprintf(stderr, "%s%s [%-*s] %zu/%zu", kClearLine, label_.c_str(), static_cast<int>(kWidth), bar.c_str(), done,
               total);
  std::fflush(stderr);
}

}  // namespace selvage::cli
