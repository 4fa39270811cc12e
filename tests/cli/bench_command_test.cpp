#include <csignal>

#include <gtest/gtest.h>

#include "tests/cli/run_program.h"

namespace selvage {

using testing::run_program;
using testing::spit;
using testing::TemporaryFolder;

TEST(BenchCommand, FramesOfTwoMeshesAreRefusedByTheirNames) {
  const TemporaryFolder folder;
  const std::string first = folder.path() / "first.obj", other = folder.path() / "other.obj";
  spit(first, "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\n");
  const struct {
    const char* mesh;
    std::string message;
  } cases[] = {
      {"v 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\nf 2 4 3\n", first + ", " + other + ": their faces differ"},
      {"v 0 0 1\nv 1 0 1\nv 0 1 1\nf 1 2 3\n", first + ", " + other + ": 4 and 3 vertices"},
      {"v 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1e305\nf 1 2 3\n", other + ": vertex 3 has the coordinate 1e+305, beyond"}};
  for (const auto& c : cases) {
    spit(other, c.mesh);
    for (const char* what : {"ccd", "broad"}) {
      SCOPED_TRACE(std::string(what) + ": " + c.message);
      const auto result = run_program(folder, {"bench", what, first, other, "--repeat", "1"});
      EXPECT_EQ(result.exit_code, 3) << result.out;
      EXPECT_NE(result.err.find(c.message), std::string::npos) << result.err;
    }
  }
}

TEST(BenchCommand, TheTruthOfAFileThatTheExactCheckerContradictsIsNamed) {
  const TemporaryFolder folder;
  const std::string file = folder.path() / "a_vf.csv";
  // A point at rest above a triangle at rest, or on it.
  const auto query = [](const char* height, const char* truth) {
    std::string rows;
    for (int end = 0; end < 2; ++end) {
      for (const char* row : {"1,4,1,4,", "0,1,0,1,0,1,", "1,1,0,1,0,1,", "0,1,1,1,0,1,"}) {
        rows += row + std::string(row[2] == '4' ? height : "") + truth + "\n";
      }
    }
    return rows;
  };
  spit(file, query("1,1,", "0") + query("0,1,", "1"));
  EXPECT_EQ(run_program(folder, {"bench", "queries", file, "--repeat", "1"}).exit_code, 0);
  spit(file, query("1,1,", "0") + query("1,1,", "1") + query("0,1,", "0"));
  const auto wrong = run_program(folder, {"bench", "queries", file, "--repeat", "1"});
  EXPECT_EQ(wrong.exit_code, 1);
  for (const char* line : {":9: the truth is contradicted", ":17: the truth is contradicted"}) {
    EXPECT_NE(wrong.err.find(file + line), std::string::npos) << wrong.err;
  }
  EXPECT_EQ(wrong.err.find(file + ":1:"), std::string::npos) << wrong.err;
  spit(file, query("0,1,", "0"));  // to which a contact that is found is a false alarm, and nothing unsafe
  EXPECT_EQ(run_program(folder, {"bench", "queries", file, "--repeat", "1"}).exit_code, 1);
}

TEST(BenchCommand, HardCasesThatAreInterruptedAre75) {
  const TemporaryFolder folder;
  const pid_t child = testing::start_program(folder.path(), {"bench", "stability", "--quick"});
  testing::wait_until_signal_is_caught(child, SIGINT);
  kill(child, SIGINT);
  const auto result = testing::wait_for_program(folder.path(), child);
  EXPECT_EQ(result.exit_code, 75) << result.out;
  EXPECT_NE(result.err.find("interrupted; nothing was written"), std::string::npos) << result.err;
}

}  // namespace selvage
