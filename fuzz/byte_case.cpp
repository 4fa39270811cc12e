#include "fuzz/byte_case.h"

#include <array>
#include <charconv>
#include <cstdio>
#include <exception>

namespace selvage::fuzz {
namespace {

constexpr std::size_t kLongestPiece = 100;

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

std::string unescaped(std::string_view piece, const CaseLines& lines) {
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
        lines.fail("'\\' is followed by n, \\ or x and two hexadecimal digits");
      }
      bytes += static_cast<char>(value);
      i += 2;
    }
  }
  return bytes;
}

}  // namespace

Retrial retry(const ByteCase& kept) {
  try {
    return kept.kind->retry(kept);
  } catch (const std::exception& error) {
    return {"threw", {error.what()}, {}};
  }
}

std::string KeptBytes::body() const {
  std::string text = std::string(kept_.kind->key) + " " + kept_.value + "\n";
  const std::string& bytes = kept_.bytes;
  for (std::size_t begin = 0; begin < bytes.size();) {
    const std::size_t line_end = bytes.find('\n', begin);
    const std::size_t left = line_end == bytes.npos ? bytes.size() - begin : line_end + 1 - begin;
    const std::size_t length = std::min(left, kLongestPiece);
    text += "| ";
    for (std::size_t i = 0; i < length; ++i) text += escaped(bytes[begin + i], i == 0 || i + 1 == length);
    text += "\n";
    begin += length;
  }
  return text;
}

ByteCase parse_byte_case(const ByteKind& kind, CaseLines& lines) {
  ByteCase kept{&kind, {}, {}};
  lines.advance();
  lines.expect_word(kind.key);
  kept.value = lines.word();
  if (!kind.is_value(kept.value)) lines.fail(std::string(kind.key) + ": '" + kept.value + "' is not known");
  lines.expect_end_of_line();
  while (!lines.only_blank_left()) {
    lines.expect_word("|");
    kept.bytes += unescaped(lines.rest_of_line(), lines);
  }
  return kept;
}

}  // namespace selvage::fuzz
