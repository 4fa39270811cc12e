#include "page/page.h"

#include <gtest/gtest.h>

#include "page/packed.h"

namespace selvage::page {
namespace {

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + part.size())) ++count;
  return count;
}

}  // namespace

TEST(PageHtml, TextOfStrangersIsEscaped) {
  EXPECT_EQ(text("<a href='x'>&\"").code, "&lt;a href=&#39;x&#39;&gt;&amp;&quot;");
  EXPECT_EQ(text("caf\xC3\xA9 \xF0\x9F\xA7\xB5").code, "caf\xC3\xA9 \xF0\x9F\xA7\xB5") << "UTF-8 stays";
  EXPECT_EQ(element("b", {{"title", "\"><script>"}}, text("x")).code, "<b title=\"&quot;&gt;&lt;script&gt;\">x</b>");
}

TEST(PageHtml, BytesThatAreNoTextAreReplaced) {
  const std::string replacement = "\xEF\xBF\xBD";
  EXPECT_EQ(text("a\xFFz").code, "a" + replacement + "z");
  EXPECT_EQ(text("a\xC3").code, "a" + replacement) << "cut off";
  EXPECT_EQ(text("\xC0\xAF").code, replacement + replacement) << "a longer form of a slash";
  EXPECT_EQ(text("\xED\xA0\x80").code, replacement + replacement + replacement) << "half a surrogate pair";
  EXPECT_EQ(text(std::string("a\0\x1b\x7f\n", 5)).code, "a" + replacement + replacement + replacement + "\n");
  EXPECT_EQ(text("\xEF\xBF\xBE\xEF\xBF\xBF").code, replacement + replacement) << "no characters, to XML";
}

TEST(Page, IsOneFileThatForbidsToLoadAnything) {
  Page page("a < b");
  page.add_header(element("h1", {}, text("clean")));
  page.add_section("Counts", table({"counts", {"what", "how many"}, {{text("pairs"), text("1 & 2")}}}), "work");
  const std::string html = page.html();
  EXPECT_TRUE(html.starts_with("<!DOCTYPE html>\n"));
  EXPECT_NE(html.find("<title>a &lt; b</title>"), html.npos);
  EXPECT_NE(html.find("default-src &#39;none&#39;"), html.npos);
  EXPECT_NE(html.find("<section id=\"work\"><h2>Counts</h2>"), html.npos);
  EXPECT_NE(html.find("<td>pairs</td><td>1 &amp; 2</td>"), html.npos);
  EXPECT_EQ(occurrences(html, "<script"), 0u);
  for (const char* loads : {"src=", "href=", "url(", "@import", "http:", "https:"}) {
    EXPECT_EQ(html.find(loads), html.npos) << loads;
  }
}

TEST(Page, DataCannotEndItsElement) {
  Page page("t");
  page.add_data("report", R"({"name": "</script><script>alert(1)</script>"})");
  const std::string html = page.html();
  EXPECT_EQ(occurrences(html, "<script"), 1u);
  EXPECT_EQ(occurrences(html, "</script"), 1u);
  EXPECT_NE(html.find(R"({"name": "\u003c/script>\u003cscript>alert(1)\u003c/script>"})"), html.npos);
}

TEST(PagePacked, Base64IsThatOfTheStandard) {
  const std::vector<std::pair<std::string, std::string>> of_rfc4648 = {{"", ""},
                                                                       {"f", "Zg=="},
                                                                       {"fo", "Zm8="},
                                                                       {"foo", "Zm9v"},
                                                                       {"foob", "Zm9vYg=="},
                                                                       {"fooba", "Zm9vYmE="},
                                                                       {"foobar", "Zm9vYmFy"}};
  for (const auto& [bytes, expected] : of_rfc4648) EXPECT_EQ(base64(bytes), expected);
  EXPECT_EQ(base64("\xFB\xFF\xFE"), "+//+");
}

}  // namespace selvage::page
