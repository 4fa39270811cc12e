// Whether a text is XML that a strict reader takes: elements that nest, quoted attributes, no bare & or <.
#pragma once

#include <regex>
#include <string>
#include <vector>

namespace selvage::testing {

/// "" or what is wrong, for XML of elements and text alone.
inline std::string fault_of_xml(const std::string& xml) {
  static const std::regex open(R"re(<([a-zA-Z]+)((?: [a-zA-Z0-9-]+="[^"<]*")*)>)re"), close(R"(</([a-zA-Z]+)>)"),
      reference("&(amp|lt|gt|quot|#39);");
  const auto at = [&](std::size_t place) { return xml.begin() + static_cast<std::ptrdiff_t>(place); };
  const auto starts_with = [&](std::size_t place, const std::regex& pattern, std::smatch& match) {
    return std::regex_search(at(place), xml.end(), match, pattern, std::regex_constants::match_continuous);
  };
  std::vector<std::string> inside;
  for (std::size_t i = 0; i < xml.size();) {
    const std::string where = " at " + xml.substr(i, 60);
    std::smatch match;
    if (xml[i] == '<' && starts_with(i, open, match)) {
      if (inside.empty() && i > 0) return "a second root" + where;
      inside.push_back(match[1]);
    } else if (xml[i] == '<' && starts_with(i, close, match)) {
      if (inside.empty() || inside.back() != match[1]) return "an end without a start" + where;
      inside.pop_back();
    } else if (xml[i] == '<') {
      return "a bare <" + where;
    } else if (xml[i] == '&' && !starts_with(i, reference, match)) {
      return "a bare &" + where;
    } else if (inside.empty() && xml[i] != '\n') {
      return "text outside" + where;
    } else if (static_cast<unsigned char>(xml[i]) < ' ' && xml[i] != '\n') {
      return "a control character" + where;
    }
    i += match.empty() ? 1 : static_cast<std::size_t>(match.length());
  }
  return inside.empty() ? "" : "no end of " + inside.back();
}

}  // namespace selvage::testing
