// The text of case files: lines of words, hex floats, comments from '#' to the end of a line.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "io/file/text.h"

namespace selvage::fuzz {

/// The shortest hex float that reads back as x; or nan, inf, -inf.
[[nodiscard]] std::string hex(double x);

/// Bytes in one line: what is not printable ASCII becomes \n, \\ or \xHH, as in C.
[[nodiscard]] std::string escaped(std::string_view bytes);

/// Reads one line after another, and within a line one word after another. `text` and `name` must outlive it. Whatever
/// does not fit throws io::Error with the name and the line.
class CaseLines {
 public:
  CaseLines(std::string_view text, const std::string& name) : rest_(io::without_byte_order_mark(text)), name_(name) {}

  /// The next line that is not empty; fails at the end of the text.
  void advance();
  [[nodiscard]] bool only_blank_left();
  [[nodiscard]] std::string_view word();
  void expect_word(std::string_view wanted);
  /// The next line: "selvage-case 1", and what is behind it.
  void expect_head();
  [[nodiscard]] bool is_at_end_of_line() const;
  void expect_end_of_line();
  /// A finite number, hexadecimal or decimal, from a word.
  [[nodiscard]] double number(std::string_view word) const;
  /// The same, or nan, inf, -inf.
  [[nodiscard]] double any_number(std::string_view word) const;
  /// An integer in [lowest, highest], from a word; `what` names it where it is none.
  [[nodiscard]] std::int64_t integer(std::string_view word, std::int64_t lowest, std::int64_t highest,
                                     std::string_view what) const;
  /// The last line, "expect touches" or "expect apart": whether it touches.
  [[nodiscard]] bool last_answer();
  /// What is left of the line, from the next word on.
  [[nodiscard]] std::string_view rest_of_line();
  /// The bytes that escaped() wrote so.
  [[nodiscard]] std::string unescaped(std::string_view piece) const;
  [[noreturn]] void fail(const std::string& what) const;

 private:
  void take_line();

  std::string_view rest_, line_;
  const std::string& name_;
  int number_ = 0;
};

}  // namespace selvage::fuzz
