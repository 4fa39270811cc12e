// Exit code 7: the program where its two deciders differ (lying_decider.cpp).
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"

namespace selvage {

using testing::run_program;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;

TEST(Disagreement, IsSevenWithoutAVerdictAndTheCaseIsKept) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", json = folder.path() / "r.json", cases = folder.path() / "cases";
  spit(mesh, "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv 1 1 -1\nv 2 1 1\nv 1 2 1\nf 4 5 6\n");
  const std::vector<std::string> arguments = {"verify", mesh, "--json", json, "--cases", cases};
  EXPECT_EQ(run_program(folder, arguments, SELVAGE_LYING_PROGRAM).exit_code, 1) << "not asked";
  std::filesystem::remove_all(cases);

  auto asked = arguments;
  asked.emplace_back("--second-opinion");
  const auto result = run_program(folder, asked, SELVAGE_LYING_PROGRAM);
  EXPECT_EQ(result.exit_code, 7) << result.out << result.err;
  EXPECT_TRUE(result.out.starts_with("unknown\n")) << result.out;
  const auto report = nlohmann::json::parse(slurp(json));
  EXPECT_EQ(report["verdict"], "unknown");
  EXPECT_EQ(report["second_opinion"]["disagreed"], 1);
  const auto part = folder.path() / "merged.json";
  EXPECT_EQ(run_program(folder, {"merge", json, "-o", part}).exit_code, 7) << "merging does not forget it";

  ASSERT_TRUE(std::filesystem::is_directory(cases));
  std::vector<std::filesystem::path> kept;
  for (const auto& entry : std::filesystem::directory_iterator(cases)) kept.push_back(entry.path());
  ASSERT_FALSE(kept.empty());
  for (const auto& file : kept) EXPECT_NE(run_program(folder, {"replay", file}).out, "") << file;
}

TEST(Disagreement, OfManyCasesTheGravestCountsWhereverItStands) {
  const TemporaryFolder folder;
  const auto divided = folder.path() / "divided.case", contradicted = folder.path() / "contradicted.case",
             broken = folder.path() / "broken.case";
  spit(divided,
       "selvage-case 1 overlap\nseed hand\na 0 0 0 0\nb 1 4 0 0\nc 2 0 4 0\nd 3 1 1 -1\ne 4 2 1 1\nf 5 1 2 1\n"
       "expect touches\n");
  spit(contradicted,
       "selvage-case 1 vf\nseed hand\noptions tolerance=0x0p+0 max_intervals=64\np 1 1 1  1 1 -1\na 0 0 0  0 0 0\n"
       "b 4 0 0  4 0 0\nc 0 4 0  0 4 0\nexpect apart\n");
  spit(broken,  // which the textbook's method misses
       "selvage-case 1 ee\nseed hand\noptions tolerance=0x0p+0 max_intervals=4096\n"
       "a -1.1e60 3.7e59 1.3e59  -1.3e60 2.9e59 -1.7e58\nb 1.9e60 1.3e59 1.7e59  2.3e60 0.7e59 -2.3e58\n"
       "c 1.1e59 -1.7e60 1.9e58  1.3e59 -2.1e60 2.3e58\nd 2.3e59 2.9e60 -3.1e58  1.9e59 3.1e60 -2.7e58\n"
       "expect touches\n");
  const auto exit_code = [&](const std::filesystem::path& a, const std::filesystem::path& b) {
    const std::vector<std::string> arguments = {"replay", "--plugin", SELVAGE_TEXTBOOK_PLUGIN, broken, a, b};
    return run_program(folder, arguments, SELVAGE_LYING_PROGRAM).exit_code;
  };
  EXPECT_EQ(exit_code(broken, broken), 1);
  EXPECT_EQ(exit_code(contradicted, broken), 3);
  EXPECT_EQ(exit_code(broken, contradicted), 3);
  EXPECT_EQ(exit_code(divided, contradicted), 7);
  EXPECT_EQ(exit_code(contradicted, divided), 7);
  EXPECT_EQ(exit_code(divided, broken), 7);
}

}  // namespace selvage
