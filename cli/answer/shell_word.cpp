#include "cli/answer/shell_word.h"

namespace selvage::cli {

std::string shell_word(const std::string& plain) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-./:,+@%";
  if (!plain.empty() && plain.find_first_not_of(kPlain) == plain.npos) return plain;
  std::string word = "'";
  for (const char c : plain) word += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return word + "'";
}

}  // namespace selvage::cli
