#include <gtest/gtest.h>

#include "tests/cli/run_program.h"

namespace selvage {

using testing::run_program;

TEST(Program, HelpStartsWithAnExample) {
  const auto result = run_program({"--help"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(result.out.starts_with("Example: selvage ")) << result.out;
  EXPECT_EQ(result.err, "");
}

TEST(Program, VersionNamesTheExactLibraries) {
  const auto result = run_program({"--version"});
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_TRUE(result.out.starts_with("selvage ")) << result.out;
  EXPECT_NE(result.out.find("GMP"), std::string::npos) << result.out;
}

TEST(Program, NoSubcommandIsUsage) {
  const auto result = run_program({});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_NE(result.err, "");
}

TEST(Program, UnknownSubcommandIsUsage) {
  const auto result = run_program({"knit"});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("knit"), std::string::npos) << result.err;
  const auto with_options = run_program({"knit", "run", "-o", "x.npz"});
  EXPECT_EQ(with_options.exit_code, 2);
  EXPECT_NE(with_options.err.find("no subcommand 'knit'"), std::string::npos) << with_options.err;
}

}  // namespace selvage
