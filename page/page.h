// One HTML file that opens offline: style, data and scripts are in it, and its policy forbids to load anything.
//
//   page::Page report("Conformance of libfoo.so");
//   report.add_header(page::element("h1", {}, page::text("conformant")));
//   report.add_section("Promises", page::table({"promises", {"promise", "cases", "broken"}, rows}));
//   report.add_data("report", json);                       // for scripts and for people with a JSON reader
//   io::write_atomically(file, report.html());
//
// The style (assets/page.css) is readable in light and dark, on paper, and by people who are colour-blind.
#pragma once

#include <string>
#include <string_view>

#include "page/html.h"

namespace selvage::page {

class Page {
 public:
  explicit Page(std::string title) : title_(std::move(title)) {}

  /// Above the sections: what the page says first.
  void add_header(const Html& content) { header_ += content; }
  /// A section with a heading; `id` may be empty.
  void add_section(std::string_view heading, const Html& content, std::string_view id = {});
  /// JSON for scripts: JSON.parse(document.getElementById(id).textContent).
  void add_data(std::string_view id, std::string_view json);
  /// What packed() or packed_integers() made: assets/unpack.js has unpack(id) and unpackIntegers(id, stride).
  void add_packed(std::string_view id, std::string_view text);
  /// Runs when the page is loaded, after those that were added before. An asset of this project, which is trusted.
  void add_script(std::string_view code);

  /// The file. Without scripts it holds none.
  [[nodiscard]] std::string html() const;

 private:
  std::string title_;
  Html header_, sections_;
  std::string data_, scripts_;
};

}  // namespace selvage::page
