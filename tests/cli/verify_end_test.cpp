// `selvage verify` that ends before its last frame: at a signal, or at the first violation.
#include <csignal>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"
#include "tests/cli/two_faces.h"

namespace selvage {

using testing::run_program;
using testing::spit;
using testing::TemporaryFolder;
using testing::two_faces;

TEST(VerifyCommand, InterruptEndsWithUnknownAnd75) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", report = folder.path() / "report.json";
  spit(mesh, two_faces(1));
  std::vector<std::string> arguments = {"verify", "--motion", "--json", report};
  arguments.insert(arguments.end(), 15000, mesh);  // many units of work
  const pid_t child = testing::start_program(folder.path(), arguments);
  testing::wait_until_signal_is_caught(child, SIGINT);
  kill(child, SIGINT);
  const auto result = testing::wait_for_program(folder.path(), child);
  EXPECT_EQ(result.exit_code, 75) << result.out << result.err;
  EXPECT_TRUE(result.out.starts_with("unknown\n")) << result.out;
  EXPECT_NE(result.out.find("stopped on request"), std::string::npos) << result.out;
  EXPECT_EQ(nlohmann::json::parse(testing::slurp(report))["verdict"], "unknown");
}

TEST(VerifyCommand, AnInterruptThatLeavesWorkIs75WhateverWasFound) {
  const TemporaryFolder folder;
  const auto bad = folder.path() / "bad.obj", good = folder.path() / "good.obj", run = folder.path() / "run",
             report = folder.path() / "report.json", merged = folder.path() / "merged.json",
             progress = folder.path() / "report.json.progress";
  spit(bad, two_faces(0));
  spit(good, two_faces(1));
  ASSERT_EQ(run_program(folder, {"convert", bad, good, "-o", run}).exit_code, 0);
  std::string frames = R"({"file":"frame_000000.npy"})"
                       "\n";
  for (int i = 0; i < 200'000; ++i)
    frames += R"({"file":"frame_000001.npy"})"
              "\n";  // more work than for a second
  spit(run / "frames.jsonl", frames);
  ASSERT_EQ(mkfifo(progress.c_str(), 0600), 0);
  const pid_t child = testing::start_program(folder.path(), {"verify", "--json", report, run});
  std::ifstream pipe(progress);  // open when the command writes what it has done in the first second
  kill(child, SIGTERM);
  std::filesystem::remove(progress);  // what is written later is a file
  pipe.ignore(std::numeric_limits<std::streamsize>::max());
  const auto result = testing::wait_for_program(folder.path(), child);
  EXPECT_EQ(result.exit_code, 75) << result.out << result.err;
  EXPECT_TRUE(result.out.starts_with("violated\n")) << result.out;
  EXPECT_NE(result.out.find("stopped on request"), std::string::npos) << result.out;
  EXPECT_EQ(nlohmann::json::parse(testing::slurp(report))["verdict"], "violated");

  const auto whole = run_program(folder, {"merge", report, "-o", merged});
  EXPECT_EQ(whole.exit_code, 1) << "what was found stands: " << whole.out << whole.err;
  EXPECT_NE(whole.out.find("stopped on request"), std::string::npos) << whole.out;
}

TEST(VerifyCommand, ASignalBehindTheLastFrameCostsNoVerdict) {
  const TemporaryFolder folder;
  const auto mesh = folder.path() / "a.obj", report = folder.path() / "report.json", page = folder.path() / "page.html";
  spit(mesh, two_faces(1));
  ASSERT_EQ(mkfifo(page.c_str(), 0600), 0);
  const pid_t child = testing::start_program(folder.path(), {"verify", mesh, "--json", report, "--html", page});
  // The report is there: what is left is the page, for whose reader the command waits.
  for (int i = 0; i < 6000 && !std::filesystem::exists(report); ++i) usleep(10000);
  kill(child, SIGTERM);
  EXPECT_NE(testing::slurp(page).find("</html>"), std::string::npos);
  const auto result = testing::wait_for_program(folder.path(), child);
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  EXPECT_TRUE(result.out.starts_with("clean\n")) << result.out;
}

TEST(VerifyCommand, FailFastStopsAndCanGoOn) {
  const TemporaryFolder folder;
  const auto bad = folder.path() / "bad.obj", good = folder.path() / "good.obj", json = folder.path() / "report.json";
  spit(bad, two_faces(0));
  spit(good, two_faces(1));
  const std::vector<std::string> all = {"verify", "--frames-only", "--json", json, good, bad, good, bad};
  std::vector<std::string> fast = all, on = all;
  fast.emplace_back("--fail-fast");
  on.emplace_back("--resume");
  const auto stopped = run_program(folder, fast);
  EXPECT_EQ(stopped.exit_code, 1) << stopped.err;
  EXPECT_TRUE(stopped.out.starts_with("violated\n")) << stopped.out;
  EXPECT_NE(stopped.out.find("stopped at the first violation after 2 of 4 frames"), std::string::npos) << stopped.out;
  EXPECT_EQ(nlohmann::json::parse(testing::slurp(json))["frames"]["checked"], 2);
  const auto progress = folder.path() / "report.json.progress";
  EXPECT_TRUE(std::filesystem::exists(progress)) << "what was checked is not checked again";

  const auto whole = run_program(folder, on);
  EXPECT_FALSE(std::filesystem::exists(progress));
  EXPECT_EQ(whole.exit_code, 1) << whole.err;
  EXPECT_EQ(whole.out.find("stopped"), std::string::npos) << whole.out;
  EXPECT_EQ(nlohmann::json::parse(testing::slurp(json))["frames"]["violated"], 2);
}

}  // namespace selvage
