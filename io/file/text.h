// Lines, tokens and numbers of text files: locale-free, correctly rounded, bounded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace selvage::io {

/// Longest line any text format may hold: a polygon of some 100,000 corners.
inline constexpr std::size_t kLongestLine = std::size_t{1} << 20;

/// `text` without the byte order mark that some editors put at its start.
[[nodiscard]] inline std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  return text;
}

/// Walks through `bytes` line by line; LF and CRLF end a line, the last may have no end. A byte order mark at the start
/// of the text is no part of it; a CR anywhere else is refused.
class LineReader {
 public:
  /// `bytes` must outlive the reader. `name` appears in errors.
  LineReader(std::string_view bytes, std::string_view name, std::size_t first_line = 1)
      : rest_(without_byte_order_mark(bytes)), name_(name), next_line_(first_line) {}

  /// The next line without its end; nothing behind the last. Throws Error above kLongestLine, and at a CR within.
  std::optional<std::string_view> next();
  /// Number of the line that next() gave last.
  [[nodiscard]] std::size_t line() const { return next_line_ - 1; }
  /// What no next() has given yet.
  [[nodiscard]] std::string_view rest() const { return rest_; }
  /// Throws Error at this line, or at `line`.
  [[noreturn]] void fail(std::string_view what) const { fail_at(line(), what); }
  [[noreturn]] void fail_at(std::size_t line, std::string_view what) const;

 private:
  std::string_view rest_, name_;
  std::size_t next_line_;
};

/// What is said of a last number behind which the text ends without a line end.
inline constexpr std::string_view kMayBeCut =
    "the last line has no end and its number may be cut; restore the file, or add the line break if it is whole";

/// Cuts the next token (separated by blanks and tabs) off `text`; empty at the end.
std::string_view next_token(std::string_view& text);
/// `text` without blanks and tabs at both ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

enum class NumberFault { kNone, kSyntax, kNotFinite, kOutOfRange };
/// The double nearest to a decimal number ("1", "+.5", "-1e-3"); no hexadecimal, no locale. Where the nearest is
/// infinity, or zero for a number that is not, that is kOutOfRange.
NumberFault parse_number(std::string_view token, double& value);
/// The same for float: rounded once, not through double.
NumberFault parse_number(std::string_view token, float& value);
/// What to tell the user about `fault` in `token`.
[[nodiscard]] std::string describe(NumberFault fault, std::string_view token);

/// A decimal integer with an optional sign; nothing if it is none or does not fit.
[[nodiscard]] std::optional<std::int64_t> parse_integer(std::string_view token);

[[nodiscard]] bool is_utf8(std::string_view text);
/// Foreign text for a terminal or a report: control characters, what turns the order of the text around (U+202A to
/// U+202E, U+2066 to U+2069), ends of lines (U+2028, U+2029) and bytes that are no UTF-8 become '?'; cut in front of
/// the character that does not fit into `most_bytes`.
[[nodiscard]] std::string printable(std::string_view text, std::size_t most_bytes = std::string_view::npos);

/// What a shell takes as one word, for commands that people copy.
[[nodiscard]] std::string shell_word(const std::string& plain);

}  // namespace selvage::io
