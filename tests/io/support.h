// Temporary folders, bytes and expected errors for the tests of files.
#pragma once

#include <bit>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "io/error.h"
#include "io/mesh_data.h"

namespace selvage::testing {

/// A folder that is removed with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "selvage-io-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make a temporary folder");
    path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code status;
    std::filesystem::remove_all(path_, status);
  }
  [[nodiscard]] std::filesystem::path operator/(std::string_view name) const { return path_ / name; }
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline void write_plainly(const std::filesystem::path& file, std::string_view bytes) {
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

inline std::string read_plainly(const std::filesystem::path& file) {
  std::ostringstream bytes;
  bytes << std::ifstream(file, std::ios::binary).rdbuf();
  return bytes.str();
}

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
