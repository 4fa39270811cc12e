// Markup into which text gets only escaped: names of files and groups come from strangers.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace selvage::page {

/// A piece of HTML. Text and attribute values enter it escaped; `code` is set directly only from literals.
struct Html {
  std::string code;

  Html& operator+=(const Html& more) {
    code += more.code;
    return *this;
  }
  friend Html operator+(Html a, const Html& b) { return a += b; }
};

using Attributes = std::initializer_list<std::pair<std::string_view, std::string_view>>;

/// The text with &, <, >, " and ' escaped, fit for content and for quoted attributes. A byte that is not part of valid
/// UTF-8, or a character that HTML or XML forbids (controls, U+FFFE, U+FFFF), becomes U+FFFD.
[[nodiscard]] Html text(std::string_view plain);
/// <tag name="value" ...>content</tag>. Tag and attribute names are literals of the caller.
[[nodiscard]] Html element(std::string_view tag, Attributes attributes, const Html& content);

struct Table {
  std::string id;  ///< of the element, for scripts and styles; may be empty
  std::vector<std::string> headings;
  std::vector<std::vector<Html>> rows;
};
/// A table in a box that scrolls sideways where the window is narrow.
[[nodiscard]] Html table(const Table& contents);

}  // namespace selvage::page
