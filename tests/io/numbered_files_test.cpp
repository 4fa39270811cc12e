// Which files a pattern names.
#include "io/numbered_files.h"

#include <fstream>

#include <gtest/gtest.h>

#include "tests/io/support.h"

namespace selvage::io {
namespace {

namespace fs = std::filesystem;

class NumberedFiles : public ::testing::Test {
 protected:
  void make(std::initializer_list<const char*> names) const {
    for (const char* name : names) std::ofstream(folder_ / name) << "x";
  }
  [[nodiscard]] std::vector<std::string> names_of(const char* pattern) const {
    std::vector<std::string> names;
    for (const fs::path& file : numbered_files(folder_.path() / pattern)) names.push_back(file.filename().string());
    return names;
  }
  struct Refusal {
    ErrorKind kind;
    std::string message;
  };
  [[nodiscard]] Refusal refusal_of(const char* pattern) const {
    try {
      (void)numbered_files(folder_.path() / pattern);
    } catch (const Error& error) {
      return {error.kind(), error.what()};
    }
    ADD_FAILURE() << pattern << " is not refused";
    return {};
  }
  void expect_missing(const char* pattern, const std::string& file) const {
    const auto [kind, message] = refusal_of(pattern);
    EXPECT_EQ(kind, ErrorKind::kFile) << message;
    EXPECT_TRUE(message.starts_with((folder_.path() / file).string() + ": cannot open: ")) << message;
  }

  testing::TemporaryFolder folder_;
};

}  // namespace

TEST_F(NumberedFiles, GoUpByOneStepInTheOrderOfTheirNumbers) {
  make({"a_9.obj", "a_10.obj", "a_11.obj", "a_x.obj", "a_.obj", "b_020.ply", "b_000.ply", "b_010.ply"});
  EXPECT_EQ(names_of("a_*.obj"), (std::vector<std::string>{"a_9.obj", "a_10.obj", "a_11.obj"}));
  EXPECT_EQ(names_of("b_*.ply"), (std::vector<std::string>{"b_000.ply", "b_010.ply", "b_020.ply"}));
  EXPECT_EQ(names_of("any.obj"), (std::vector<std::string>{"any.obj"}));
}

TEST_F(NumberedFiles, TheOneThatIsMissingIsNamed) {
  make({"walk_9.obj", "walk_11.obj", "walk_12.obj"});
  expect_missing("walk_*.obj", "walk_10.obj");
  make({"run_008.obj", "run_009.obj", "run_011.obj"});
  expect_missing("run_*.obj", "run_010.obj");
  make({"every_00.obj", "every_10.obj", "every_30.obj"});
  expect_missing("every_*.obj", "every_20.obj");
  make({"second_1.obj", "second_3.obj", "second_4.obj"});
  expect_missing("second_*.obj", "second_2.obj");
}

TEST_F(NumberedFiles, NoneAtAllIsAFileThatIsNotThere) { expect_missing("walk_*.obj", "walk_*.obj"); }

// Negative frames are a run-up, and fractions are sub-frames: neither may be left out unseen.
TEST_F(NumberedFiles, NumbersThatNoFrameHasAreRefused) {
  make({"up_-1.obj", "up_0.obj", "half_1.5.obj", "half_1.obj", "long_1234567890123456789.obj", "long_1.obj"});
  for (const auto& [pattern, file] : {std::pair("up_*.obj", "up_-1.obj"), std::pair("half_*.obj", "half_1.5.obj"),
                                      std::pair("long_*.obj", "long_1234567890123456789.obj")}) {
    const auto [kind, message] = refusal_of(pattern);
    EXPECT_EQ(kind, ErrorKind::kBadInput);
    EXPECT_NE(message.find(file), std::string::npos) << message;
  }
  make({"v_1.obj", "v_1.2.3.obj", "v_-.obj", "v_.5.obj", "v_1..obj", "v_999999999999999999.x.obj"});
  EXPECT_EQ(names_of("v_*.obj"), std::vector<std::string>{"v_1.obj"}) << "the others are no numbers";
}

TEST_F(NumberedFiles, WhatIsNoNumberingIsRefused) {
  make({"twice_1.obj", "twice_01.obj", "odd_0.obj", "odd_4.obj", "odd_10.obj"});
  EXPECT_EQ(refusal_of("twice_*.obj").kind, ErrorKind::kBadInput);
  EXPECT_NE(refusal_of("twice_*.obj").message.find("twice_01.obj and twice_1.obj have the same number"),
            std::string::npos);
  EXPECT_EQ(refusal_of("odd_*.obj").kind, ErrorKind::kBadInput);
  EXPECT_NE(refusal_of("odd_*.obj").message.find("after odd_4.obj comes odd_10.obj"), std::string::npos);
  EXPECT_EQ(refusal_of("*_*.obj").kind, ErrorKind::kBadInput);
}

}  // namespace selvage::io
