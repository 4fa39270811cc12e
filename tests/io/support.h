// Bytes, and the errors that are expected of them, for the tests of files.
#pragma once

#include <bit>
#include <cstdint>
#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "io/error.h"
#include "io/mesh_data.h"
#include "tests/temporary_folder.h"

namespace selvage::testing {

/// Runs `action`, which must throw io::Error of `kind` in one line that holds `fragment`.
inline void expect_error(io::ErrorKind kind, const std::string& fragment, const std::function<void()>& action) {
  try {
    action();
  } catch (const io::Error& error) {
    const std::string message = error.what();
    EXPECT_EQ(error.kind(), kind) << message;
    EXPECT_NE(message.find(fragment), std::string::npos) << "expected: " << fragment << "\nmessage:  " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_NE(message.find("; "), std::string::npos) << "no remedy: " << message;
    return;
  }
  ADD_FAILURE() << "nothing thrown; expected: " << fragment;
}

/// Equal to the last bit: tells -0 from 0.
inline bool same_bits(const io::Points& a, const io::Points& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (std::bit_cast<std::uint64_t>(a[i][axis]) != std::bit_cast<std::uint64_t>(b[i][axis])) return false;
    }
  }
  return true;
}

}  // namespace selvage::testing
