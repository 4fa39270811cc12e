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

}  // namespace selvage
