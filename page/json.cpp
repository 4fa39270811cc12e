#include "page/json.h"

#include <cstdio>

#include "page/utf8.h"

namespace selvage::page {

std::string json_string(std::string_view plain) {
  std::string quoted = "\"";
  for (std::size_t i = 0; i < plain.size();) {
    const std::size_t length = character_length(plain.substr(i));
    const char c = plain[i];
    if (length == 0) {
      quoted += kReplacement;
    } else if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < ' ') {
      char escape[8];
      std::snprintf(escape, sizeof escape, "\\u%04x", static_cast<unsigned>(static_cast<unsigned char>(c)));
      quoted += escape;
    } else {
      quoted += plain.substr(i, length);
    }
    i += length == 0 ? 1 : length;
  }
  return quoted + "\"";
}

std::string json_number(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.17g", value);
  return buffer;
}

}  // namespace selvage::page
