#include "fuzz/kept/byte_case.h"

#include <exception>

#include "fuzz/base/deaths.h"

namespace selvage::fuzz {
namespace {

constexpr std::size_t kLongestPiece = 100;

}  // namespace

Retrial retry(const ByteCase& kept) {
  try {
    return kept.kind->retry(kept);
  } catch (const std::exception& error) {
    return {kThrew, {error.what()}, {}};
  }
}

std::string KeptBytes::body() const {
  std::string text = std::string(kept_.kind->key) + " " + kept_.value + "\n";
  const std::string& bytes = kept_.bytes;
  for (std::size_t begin = 0; begin < bytes.size();) {
    const std::size_t line_end = bytes.find('\n', begin);
    const std::size_t left = line_end == bytes.npos ? bytes.size() - begin : line_end + 1 - begin;
    const std::size_t length = std::min(left, kLongestPiece);
    text += "| " + escaped(bytes.substr(begin, length)) + "\n";
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
    kept.bytes += lines.unescaped(lines.rest_of_line());
  }
  return kept;
}

}  // namespace selvage::fuzz
