#include "cli/shell_word.h"

#include <algorithm>
#include <cctype>
#include <cstring>

namespace selvage::cli {

std::string shell_word(const std::string& plain) {
  const auto is_plain = [](unsigned char c) { return std::isalnum(c) != 0 || std::strchr("/._-+:,@", c) != nullptr; };
  if (std::ranges::all_of(plain, is_plain)) return plain;
  std::string word = "'";
  for (const char c : plain) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

}  // namespace selvage::cli
