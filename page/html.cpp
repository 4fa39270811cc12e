#include "page/html.h"

#include "page/utf8.h"

namespace selvage::page {

Html text(std::string_view plain) {
  Html result;
  for (std::size_t i = 0; i < plain.size();) {
    const std::size_t length = character_length(plain.substr(i));
    const char c = plain[i];
    const bool forbidden = length == 1 && (c == '\x7f' || (c < ' ' && c != '\n' && c != '\t'));
    const bool none = length == 3 && (plain.substr(i, 3) == "\xEF\xBF\xBE" || plain.substr(i, 3) == "\xEF\xBF\xBF");
    if (length == 0 || forbidden || none) {
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
