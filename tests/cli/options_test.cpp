// Values of options that make no sense are refused before any work, and named.
#include <gtest/gtest.h>

#include "tests/cli/run_program.h"

namespace selvage {
namespace {

using testing::run_program;

struct Mistake {
  std::vector<std::string> arguments;
  std::string option, words;  ///< in the message
};

void expect_usage_errors(const std::vector<Mistake>& mistakes) {
  for (const Mistake& mistake : mistakes) {
    const auto result = run_program(mistake.arguments);
    EXPECT_EQ(result.exit_code, 2) << mistake.arguments[0] << mistake.option << result.out << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find(mistake.option), std::string::npos) << result.err;
    EXPECT_NE(result.err.find(mistake.words), std::string::npos) << result.err;
  }
}

}  // namespace

TEST(Options, ANumberIsFinite) {
  for (const std::string value : {"nan", "-nan", "inf"}) {
    const std::string words = "'" + value + "' is not a number ";
    expect_usage_errors({
        {{"bench", "ccd", "--tolerance", value}, "--tolerance", words + "from 0 up"},
        {{"bench", "queries", "none.csv", "--tolerance", value}, "--tolerance", words + "from 0 up"},
        {{"bench", "broad", "--pleats", value}, "--pleats", words + "from 0.01 to 1"},
        {{"render", "none", "-o", "a.png", "--azimuth", value}, "--azimuth", words + "from -360 to 360"},
        {{"render", "none", "-o", "a.png", "--elevation", value}, "--elevation", words + "from -89 to 89"},
        {{"fuzz", "ccd", "--cases", "1", "--case-time", value}, "--case-time", words + "above 0"},
        {{"fuzz", "ccd", "--time", value}, "--time", "60s"},
        {{"verify", "none.obj", "--min-distance", value}, "--min-distance", words + "from 0 up"},
    });
  }
}

TEST(Options, ANumberThatWouldBeRoundedToZeroIsRefused) {
  for (const std::string value : {"1e-400", "0x1p-1100", "1e-9999"}) {
    const std::string words = "'" + value + "' is too small: it would be rounded to 0";
    expect_usage_errors({
        {{"verify", "none.obj", "--min-distance", value}, "--min-distance", words},
        {{"bench", "ccd", "--tolerance", value}, "--tolerance", words},
        {{"fuzz", "ccd", "--cases", "1", "--case-time", value}, "--case-time", words},
    });
  }
  for (const std::string value : {"0", "0e-400", "5e-324", "1e-310"}) {
    EXPECT_EQ(run_program({"verify", "none.obj", "--min-distance", value}).exit_code, 4) << value << ": no such file";
  }
}

TEST(Options, TheRangeIsSaidInShort) {
  expect_usage_errors({
      {{"verify", "none.obj", "--max-violations", "-1"}, "--max-violations", "'-1' is not a number from 0 up"},
      {{"fuzz", "ccd", "--cases", "0"}, "--cases", "'0' is not a number from 1 up"},
      {{"fuzz", "ccd", "--jobs", "0"}, "--jobs", "'0' is not a number from 1 up"},
      {{"fuzz", "ccd", "--case-time", "0"}, "--case-time", "'0' is not a number above 0"},
      {{"bench", "queries", "none.csv", "--tolerance", "-1"}, "--tolerance", "'-1' is not a number from 0 up"},
  });
}

TEST(Options, AFrameIsAWholeNumber) {
  for (const std::string frame : {"-1", "1.5", "", "99999999999999999999"}) {
    const std::string words = "'" + frame + "' is not a whole number";
    expect_usage_errors({
        {{"render", "none", "-o", "a.png", "--frames", frame}, "--frames", words},
        {{"subdivide", "none", "-o", "none", "--frame", frame}, "--frame", words},
    });
  }
}

TEST(Options, HelpIsPlainText) {
  for (const char* command :
       {"bench", "convert", "doctor", "fuzz", "merge", "render", "replay", "sim", "subdivide", "verify", "view"}) {
    const auto help = run_program({command, "--help"});
    EXPECT_EQ(help.exit_code, 0) << command;
    for (const unsigned char c : help.out) ASSERT_TRUE(c == '\n' || c >= 0x20) << command << help.out;
    EXPECT_EQ(help.out.find("ENUM"), std::string::npos) << help.out;
  }
  const std::string sim = run_program({"sim", "--help"}).out;
  EXPECT_NE(sim.find("--quality draft|full"), std::string::npos) << sim;
}

TEST(Options, AChoiceIsOneOfItsWords) {
  for (const std::string value : {"1", "0", "", "Y"}) {
    const std::string words = "'" + value + "' is not ";
    expect_usage_errors({
        {{"sim", "none.toml", "-o", "none", "--record", value}, "--record", words + "frames|steps"},
        {{"sim", "none.toml", "-o", "none", "--quality", value}, "--quality", words + "draft|full"},
        {{"view", "none", "-o", "none", "--up", value}, "--up", words + "y|z"},
        {{"render", "none", "-o", "none.png", "--up", value}, "--up", words + "y|z"},
    });
  }
}

TEST(Options, ANumberOfACaseIsWhole) {
  for (const std::string number : {"99999999999999999999", "-1", "", "1x", "soup"}) {
    expect_usage_errors({{{"fuzz", "step", "--only", "soup:" + number}, "--only", "'soup:" + number + "'"}});
  }
  expect_usage_errors({{{"fuzz", "step", "--cases", "1", "--seed", "-1"}, "--seed", "'-1' is not a whole number"}});
}

TEST(Options, AFolderThatCannotBeMadeIsFour) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "file";
  testing::spit(file, "whole");
  for (const std::filesystem::path& artifacts : {file, std::filesystem::path("/proc/x")}) {
    const auto result = run_program(folder, {"fuzz", "ccd", "--cases", "10", "--artifacts", artifacts});
    EXPECT_EQ(result.exit_code, 4) << result.out << result.err;
    EXPECT_NE(result.err.find(artifacts.string() + ": cannot use: "), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("; check the path"), std::string::npos) << result.err;
  }
  EXPECT_EQ(testing::slurp(file), "whole");
}

}  // namespace selvage
