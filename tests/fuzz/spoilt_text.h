// Texts of cases in which something is wrong, and that they are refused.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "io/error.h"

namespace selvage::testing {

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

/// `parse` refuses the text as bad input, in these words.
template <class Parse>
void expect_bad_input(const Parse& parse, const std::string& text, const std::string& words) {
  try {
    parse();
    ADD_FAILURE() << "accepted:\n" << text;
  } catch (const io::Error& error) {
    EXPECT_EQ(error.kind(), io::ErrorKind::kBadInput);
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

}  // namespace selvage::testing
