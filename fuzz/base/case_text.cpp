#include "fuzz/base/case_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <system_error>

#include "io/error.h"

namespace selvage::fuzz {
namespace {

constexpr std::string_view kBlank = " \t\r";

std::size_t word_start(std::string_view line) { return std::min(line.find_first_not_of(kBlank), line.size()); }

bool is_printable(char c) { return c > ' ' && c <= '~' && c != '\\' && c != '#'; }

/// Blanks are themselves within a piece, where no editor takes them away.
std::string escaped(char c, bool at_edge) {
  if (is_printable(c) || (c == ' ' && !at_edge)) return {c};
  if (c == '\n') return "\\n";
  if (c == '\\') return "\\\\";
  std::array<char, 8> code{};
  std::snprintf(code.data(), code.size(), "\\x%02x", static_cast<unsigned>(static_cast<unsigned char>(c)));
  return code.data();
}

}  // namespace

std::string hex(double x) {
  if (std::isnan(x)) return "nan";
  if (std::isinf(x)) return x < 0 ? "-inf" : "inf";
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), std::abs(x), std::chars_format::hex).ptr;
  return (std::signbit(x) ? "-0x" : "0x") + std::string(text.data(), end);
}

std::string escaped(std::string_view bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); ++i) text += escaped(bytes[i], i == 0 || i + 1 == bytes.size());
  return text;
}

void CaseLines::advance() {
  line_ = {};
  while (word_start(line_) == line_.size()) {
    if (rest_.empty()) fail("the case ends too early; copy it again");
    take_line();
  }
}

bool CaseLines::only_blank_left() {
  while (!rest_.empty()) {
    take_line();
    if (word_start(line_) != line_.size()) return false;
  }
  return true;
}

std::string_view CaseLines::word() {
  line_.remove_prefix(word_start(line_));
  if (line_.empty()) fail("a word is missing; copy the case again");
  const std::size_t length = std::min(line_.find_first_of(kBlank), line_.size());
  const std::string_view found = line_.substr(0, length);
  line_.remove_prefix(length);
  return found;
}

void CaseLines::expect_word(std::string_view wanted) {
  const std::string_view found = word();
  if (found == wanted) return;
  fail("expected '" + std::string(wanted) + "', not '" + std::string(found) + "'; copy the case again");
}

void CaseLines::expect_head() {
  advance();
  expect_word("selvage-case");
  const std::string_view version = word();
  if (version == "1") return;
  fail("cases of version '" + std::string(version) + "' are not known here; replay it with the selvage that wrote it");
}

bool CaseLines::is_at_end_of_line() const { return word_start(line_) == line_.size(); }

void CaseLines::expect_end_of_line() {
  if (!is_at_end_of_line()) fail("unexpected '" + std::string(word()) + "'; remove it");
}

double CaseLines::number(std::string_view word) const {
  std::string_view digits = word;
  const bool negative = digits.starts_with('-');
  if (negative) digits.remove_prefix(1);
  const bool is_hex = digits.starts_with("0x");
  if (is_hex) digits.remove_prefix(2);
  double x = 0;
  const auto format = is_hex ? std::chars_format::hex : std::chars_format::general;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), x, format);
  if (error != std::errc() || end != digits.data() + digits.size() || digits.starts_with('-') || !std::isfinite(x)) {
    fail("'" + std::string(word) + "' is not a finite number; correct it");
  }
  return negative ? -x : x;
}

double CaseLines::any_number(std::string_view word) const {
  if (word == "nan") return std::numeric_limits<double>::quiet_NaN();
  if (word == "inf") return std::numeric_limits<double>::infinity();
  if (word == "-inf") return -std::numeric_limits<double>::infinity();
  return number(word);
}

std::int64_t CaseLines::integer(std::string_view word, std::int64_t lowest, std::int64_t highest,
                                std::string_view what) const {
  std::int64_t x = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
  if (error != std::errc() || end != word.data() + word.size() || x < lowest || x > highest) {
    fail(std::string(what) + ": '" + std::string(word) + "' is not an integer from " + std::to_string(lowest) + " to " +
         std::to_string(highest));
  }
  return x;
}

bool CaseLines::last_answer() {
  advance();
  expect_word("expect");
  const std::string_view answer = word();
  if (answer != "touches" && answer != "apart") fail("the answer is 'touches' or 'apart'");
  expect_end_of_line();
  if (!only_blank_left()) fail("nothing may follow 'expect'; remove it");
  return answer == "touches";
}

std::string_view CaseLines::rest_of_line() {
  const std::string_view rest = line_.substr(word_start(line_));
  line_ = {};
  return rest;
}

std::string CaseLines::unescaped(std::string_view piece) const {
  std::string bytes;
  for (std::size_t i = 0; i < piece.size(); ++i) {
    if (piece[i] != '\\') {
      bytes += piece[i];
      continue;
    }
    const char code = ++i < piece.size() ? piece[i] : '\0';
    if (code == 'n') {
      bytes += '\n';
    } else if (code == '\\') {
      bytes += '\\';
    } else {
      unsigned value = 0;
      const std::string_view digits = code == 'x' ? piece.substr(i + 1, 2) : std::string_view();
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
      if (error != std::errc() || digits.size() != 2 || end != digits.data() + 2) {
        fail("'\\' is followed by n, \\ or x and two hexadecimal digits");
      }
      bytes += static_cast<char>(value);
      i += 2;
    }
  }
  return bytes;
}

void CaseLines::fail(const std::string& what) const {
  throw io::Error(io::ErrorKind::kBadInput, name_ + ":" + std::to_string(std::max(number_, 1)) + ": " + what);
}

void CaseLines::take_line() {
  const std::size_t length = std::min(rest_.find('\n'), rest_.size());
  line_ = rest_.substr(0, length);
  line_ = line_.substr(0, line_.find('#'));
  rest_.remove_prefix(std::min(length + 1, rest_.size()));
  ++number_;
}

}  // namespace selvage::fuzz
