#include "io/file/text.h"

#include <string>

#include <gtest/gtest.h>

namespace selvage::io {

TEST(Text, WhatATerminalWouldObeyIsMasked) {
  const struct {
    const char *text, *shown;
  } kCases[] = {{"a\x1b[2Jb\x7f", "a?[2Jb?"},
                {"\xc2\x80\xc2\x9f", "??"},  // U+0080, U+009F
                {"\xff\xe2\x80", "???"},     // no UTF-8
                // U+202A to U+202E, U+2066 to U+2069: what follows is shown in another order than it is.
                {"\xe2\x80\xaa.\xe2\x80\xab.\xe2\x80\xac.\xe2\x80\xad.\xe2\x80\xae", "?.?.?.?.?"},
                {"gnp.\xe2\x81\xa6.\xe2\x81\xa7.\xe2\x81\xa8.\xe2\x81\xa9", "gnp.?.?.?.?"},
                {"one\xe2\x80\xa8two\xe2\x80\xa9three", "one?two?three"}};  // U+2028, U+2029: ends of lines
  for (const auto& c : kCases) EXPECT_EQ(printable(c.text), c.shown);
}

TEST(Text, NamesInAnyLanguageStayReadable) {
  for (const std::string name :
       {"\xc3\x84rmel",                               // Latin
        "\xd7\xa9\xd7\x9c\xd7\x95\xd7\x9d",           // Hebrew, which goes from right to left by itself
        "\xe2\x80\xa7 \xe2\x80\xaf \xe2\x80\xb0",     // U+2027, U+202F, U+2030: beside what is masked
        "\xe2\x81\xa5 \xe2\x81\xaa \xe2\x81\xb0",     // U+2065, U+206A, U+2070
        "\xe2\x80\x8d \xe2\x82\xac \xe7\xb5\xb9",     // a joiner, as in names and emoji; a sign; Han
        "\xc2\xa0 \xe3\x80\xa8 \xf0\x9f\xa7\xb5"}) {  // U+00A0, U+3028, and four bytes
    EXPECT_EQ(printable(name), name);
  }
}

TEST(Text, IsCutBeforeTheCharacterThatDoesNotFit) {
  EXPECT_EQ(printable("a\xe2\x82\xac", 3), "a");
  EXPECT_EQ(printable("a\xe2\x80\xae"
                      "b",
                      3),
            "a?b");
}

}  // namespace selvage::io
