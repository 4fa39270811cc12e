#include "page/html.h"

#include <cstdint>

namespace selvage::page {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

/// The length of the UTF-8 character that `bytes` starts with (Unicode 15, table 3-7), or 0.
std::size_t character_length(std::string_view bytes) {
  const auto byte = [&](std::size_t i) { return i < bytes.size() ? static_cast<std::uint8_t>(bytes[i]) : 0u; };
  const auto continues = [&](std::size_t i, unsigned lower = 0x80, unsigned upper = 0xBF) {
    return byte(i) >= lower && byte(i) <= upper;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (first >= 0xC2 && first <= 0xDF) return continues(1) ? 2 : 0;
  if (first >= 0xE0 && first <= 0xEF) {
    const bool good = continues(1, first == 0xE0 ? 0xA0 : 0x80, first == 0xED ? 0x9F : 0xBF) && continues(2);
    return good ? 3 : 0;
  }
  if (first >= 0xF0 && first <= 0xF4) {
    const bool good =
        continues(1, first == 0xF0 ? 0x90 : 0x80, first == 0xF4 ? 0x8F : 0xBF) && continues(2) && continues(3);
    return good ? 4 : 0;
  }
  return 0;
}

}  // namespace

Html text(std::string_view plain) {
  Html result;
  for (std::size_t i = 0; i < plain.size();) {
    const std::size_t length = character_length(plain.substr(i));
    const char c = plain[i];
    const bool forbidden = length == 1 && (c == '\x7f' || (c >= 0 && c < ' ' && c != '\n' && c != '\t'));
    if (length == 0 || forbidden) {
      result.code += kReplacement;
    } else if (c == '&') {
      result.code += "&amp;";
    } else if (c == '<') {
      result.code += "&lt;";
    } else if (c == '>') {
      result.code += "&gt;";
    } else if (c == '"') {
      result.code += "&quot;";
    } else if (c == '\'') {
      result.code += "&#39;";
    } else {
      result.code += plain.substr(i, length);
    }
    i += length == 0 ? 1 : length;
  }
  return result;
}

Html element(std::string_view tag, Attributes attributes, const Html& content) {
  Html result{"<" + std::string(tag)};
  for (const auto& [name, value] : attributes) {
    result.code += " " + std::string(name) + "=\"" + text(value).code + "\"";
  }
  result.code += ">" + content.code + "</" + std::string(tag) + ">";
  return result;
}

Html table(const Table& contents) {
  Html head, body;
  for (const std::string& heading : contents.headings) head += element("th", {{"scope", "col"}}, text(heading));
  for (const std::vector<Html>& row : contents.rows) {
    Html cells;
    for (const Html& cell : row) cells += element("td", {}, cell);
    body += element("tr", {}, cells) + Html{"\n"};
  }
  const Html inside = element("thead", {}, element("tr", {}, head)) + Html{"\n"} + element("tbody", {}, body);
  const Html whole =
      contents.id.empty() ? element("table", {}, inside) : element("table", {{"id", contents.id}}, inside);
  return element("div", {{"class", "scroll"}}, whole);
}

}  // namespace selvage::page
