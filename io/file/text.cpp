#include "io/file/text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <system_error>

#include "io/fail.h"

namespace selvage::io {
namespace {

constexpr std::string_view kBlanks = " \t";

/// std::from_chars takes no leading '+'.
std::string_view without_plus(std::string_view token) {
  if (token.size() > 1 && token[0] == '+' && token[1] != '-' && token[1] != '+') token.remove_prefix(1);
  return token;
}

template <typename Real>
NumberFault parse_real(std::string_view token, Real& value) {
  token = without_plus(token);
  const char* end = token.data() + token.size();
  const std::from_chars_result result = std::from_chars(token.data(), end, value);
  if (result.ec == std::errc::invalid_argument || result.ptr != end) {
    return token.find(".#") != token.npos ? NumberFault::kNotFinite : NumberFault::kSyntax;  // 1.#INF, 1.#QNAN
  }
  if (result.ec == std::errc::result_out_of_range) return NumberFault::kOutOfRange;
  return std::isfinite(value) ? NumberFault::kNone : NumberFault::kNotFinite;
}

}  // namespace

std::optional<std::string_view> LineReader::next() {
  if (rest_.empty()) return std::nullopt;
  ++next_line_;
  std::string_view line = rest_.substr(0, kLongestLine + 1);
  const std::size_t length = line.find('\n');
  line = line.substr(0, length);
  if (line.ends_with('\r')) line.remove_suffix(1);
  if (line.find('\r') != line.npos) {  // in a comment it would take the statement behind it along
    fail("a CR without LF, which some programs take for the end of a line; save the file with LF line ends");
  }
  if (length == line.npos && rest_.size() > kLongestLine) {
    fail("line longer than " + std::to_string(kLongestLine) + " bytes; is this a text file?");
  }
  rest_.remove_prefix(length == line.npos ? rest_.size() : length + 1);
  return line;
}

void LineReader::fail_at(std::size_t line, std::string_view what) const { bad_input_at_line(name_, line, what); }

std::string_view next_token(std::string_view& text) {
  const auto is_blank = [](char c) { return c == ' ' || c == '\t'; };
  const char* const begin = std::find_if_not(text.data(), text.data() + text.size(), is_blank);
  const char* const end = std::find_if(begin, text.data() + text.size(), is_blank);
  text = {end, text.data() + text.size()};
  return {begin, end};
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) + 1 - begin);
}

NumberFault parse_number(std::string_view token, double& value) { return parse_real(token, value); }
NumberFault parse_number(std::string_view token, float& value) { return parse_real(token, value); }

std::string describe(NumberFault fault, std::string_view token) {
  switch (fault) {
    case NumberFault::kNotFinite:
      return in_quotes(token) + " is not finite; repair the export";
    case NumberFault::kOutOfRange:
      return in_quotes(token) + " is outside the range of the number type; rescale it";
    default:
      return in_quotes(token) + " is not a decimal number; correct it";
  }
}

std::optional<std::int64_t> parse_integer(std::string_view token) {
  token = without_plus(token);
  std::int64_t value = 0;
  const char* end = token.data() + token.size();
  const std::from_chars_result result = std::from_chars(token.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return value;
}

bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size();) {
    const auto lead = static_cast<unsigned char>(text[i++]);
    if (lead < 0x80) continue;
    const int following = lead >= 0xf0 ? 3 : lead >= 0xe0 ? 2 : 1;
    if (lead < 0xc2 || lead > 0xf4) return false;  // continuation, overlong, or beyond U+10FFFF
    for (int k = 0; k < following; ++k, ++i) {
      if (i == text.size()) return false;
      const auto byte = static_cast<unsigned char>(text[i]);
      unsigned low = 0x80, high = 0xbf;
      if (k == 0) {  // the second byte excludes overlong forms, surrogates and numbers beyond U+10FFFF
        if (lead == 0xe0) low = 0xa0;
        if (lead == 0xed) high = 0x9f;
        if (lead == 0xf0) low = 0x90;
        if (lead == 0xf4) high = 0x8f;
      }
      if (byte < low || byte > high) return false;
    }
  }
  return true;
}

namespace {

/// Of a whole character of UTF-8: a terminal would obey it, or show the text around it as what it is not.
bool is_control(std::string_view character) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(character[i]); };
  if (character.size() == 1) return byte(0) < 0x20 || byte(0) == 0x7f;
  if (character.size() == 2) return byte(0) == 0xc2 && byte(1) < 0xa0;
  if (character.size() != 3 || byte(0) != 0xe2) return false;
  const unsigned number = 0x2000U | (byte(1) & 0x3fU) << 6 | (byte(2) & 0x3fU);
  return (0x2028 <= number && number <= 0x202e) || (0x2066 <= number && number <= 0x2069);
}

}  // namespace

std::string printable(std::string_view text, std::size_t most_bytes) {
  std::string result;
  while (!text.empty()) {
    const auto lead = static_cast<unsigned char>(text[0]);
    const std::size_t length = lead >= 0xf0 ? 4 : lead >= 0xe0 ? 3 : lead >= 0x80 ? 2 : 1;
    std::string_view character = text.substr(0, length);
    const bool is_whole = is_utf8(character);
    text.remove_prefix(is_whole ? character.size() : 1);
    if (!is_whole || is_control(character)) character = "?";
    if (result.size() + character.size() > most_bytes) break;
    result += character;
  }
  return result;
}

std::string shell_word(const std::string& plain) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./:,+@%";
  if (!plain.empty() && plain.find_first_not_of(kPlain) == plain.npos) return plain;
  std::string word = "'";
  for (const char c : plain) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

}  // namespace selvage::io
