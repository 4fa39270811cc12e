#include "page/page.h"

#include "page/assets.h"

namespace selvage::page {
namespace {

/// No address, not even of the page's own folder: what is not in the file is not loaded.
constexpr std::string_view kPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:; base-uri 'none'; "
    "form-action 'none'";

/// "<" would let a string end the element; in JSON it stands only in strings, where this is the same character.
std::string json_in_script(std::string_view json) {
  std::string safe;
  for (const char c : json) {
    if (c == '<') {
      safe += "\\u003c";
    } else {
      safe += c;
    }
  }
  return safe;
}

}  // namespace

void Page::add_section(std::string_view heading, const Html& content, std::string_view id) {
  const Html inside = element("h2", {}, text(heading)) + Html{"\n"} + content;
  sections_ += (id.empty() ? element("section", {}, inside) : element("section", {{"id", id}}, inside)) + Html{"\n"};
}

void Page::add_data(std::string_view id, std::string_view json) {
  const Html content{"\n" + json_in_script(json) + "\n"};
  data_ += element("script", {{"type", "application/json"}, {"id", id}}, content).code + "\n";
}

void Page::add_packed(std::string_view id, std::string_view packed) {
  data_ += element("script", {{"type", "text/plain"}, {"id", id}}, Html{std::string(packed)}).code + "\n";
}

void Page::add_script(std::string_view code) { scripts_ += "<script>\n" + std::string(code) + "\n</script>\n"; }

std::string Page::html() const {
  const Html head = Html{"<meta charset=\"utf-8\">\n<meta http-equiv=\"Content-Security-Policy\" content=\""} +
                    text(kPolicy) + Html{"\">\n<meta name=\"viewport\" content=\"width=device-width\">\n"} +
                    element("title", {}, text(title_)) + Html{"\n<style>\n" + asset("page.css") + "</style>\n"};
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n" + head.code + "</head>\n<body>\n<header>\n" + header_.code +
         "\n</header>\n<main>\n" + sections_.code + "</main>\n" + data_ + scripts_ + "</body>\n</html>\n";
}

}  // namespace selvage::page
