// Sequences that are checked in pieces: shards and their merge, runs that are killed and resumed.
#include <csignal>
#include <cstdlib>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"

namespace selvage {
namespace {

using testing::run_program;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;

/// A wavy height field of 2 n^2 faces at a height.
std::string sheet(int n, double height) {
  std::string obj;
  for (int j = 0; j <= n; ++j) {
    for (int i = 0; i <= n; ++i) obj += fmt::format("v {} {} {}\n", i, j, height + (7 * i * i + 3 * i * j) % 16 / 32.0);
  }
  for (int j = 0; j < n; ++j) {
    for (int i = 1; i <= n; ++i) {
      const int a = j * (n + 1) + i, c = a + n + 1;
      obj += fmt::format("f {} {} {}\nf {} {} {}\n", a, a + 1, c + 1, a, c + 1, c);
    }
  }
  return obj;
}

std::vector<std::string> sequence(const std::filesystem::path& folder, int frames, int n) {
  std::vector<std::string> files;
  for (int i = 0; i < frames; ++i) {
    files.push_back(folder / fmt::format("{:03}.obj", i));
    spit(files.back(), sheet(n, 0.125 * i));
  }
  return files;
}

std::vector<std::string> verify(const std::vector<std::string>& files, std::vector<std::string> options) {
  std::vector<std::string> arguments = {"verify", "--motion"};
  arguments.insert(arguments.end(), files.begin(), files.end());
  arguments.insert(arguments.end(), options.begin(), options.end());
  return arguments;
}

/// Without what no two runs share.
nlohmann::json report(const std::filesystem::path& file) {
  auto json = nlohmann::json::parse(slurp(file));
  json.erase("seconds");
  return json;
}

}  // namespace

TEST(LongRuns, APartIsNotOverwrittenByTheWhole) {
  const TemporaryFolder folder;
  const auto a = folder.path() / "a.obj", b = folder.path() / "b.obj", parts = folder.path() / "parts";
  spit(a, sheet(1, 0));
  spit(b, sheet(1, 1));
  std::filesystem::create_directory(parts);
  for (const std::string i : {"1", "2"}) {
    const auto part = run_program(folder, {"verify", a, b, "--shard", i + "/2", "--json", parts / (i + ".json")});
    ASSERT_EQ(part.exit_code, 0) << part.err;
  }
  const std::string first = slurp(parts / "1.json");
  const auto refused = run_program(folder, {"merge", parts, "-o", parts / "1.json"});
  EXPECT_EQ(refused.exit_code, 2) << refused.out;
  EXPECT_NE(refused.err.find("1.json is a report of " + parts.string() + " that is read, and would be overwritten"),
            std::string::npos)
      << refused.err;
  EXPECT_EQ(slurp(parts / "1.json"), first);
  for (int i = 0; i < 2; ++i) {  // that of an earlier merge is none of the parts
    EXPECT_EQ(run_program(folder, {"merge", parts, "-o", parts / "whole.json"}).exit_code, 0);
  }
  for (const char* part : {"1.json", "2.json"}) std::filesystem::remove(parts / part);
  const auto alone = run_program(folder, {"merge", parts, "-o", parts / "whole.json"});
  EXPECT_EQ(alone.exit_code, 2) << alone.err;
}

TEST(LongRuns, ShardsMergeIntoTheWhole) {
  const TemporaryFolder folder;
  const auto files = sequence(folder.path(), 7, 3);
  const auto shards = folder.path() / "shards", whole = folder.path() / "whole.json", merged = shards / "merged.json";
  std::filesystem::create_directory(shards);
  ASSERT_EQ(run_program(folder, verify(files, {"--gap", "--second-opinion", "--json", whole})).exit_code, 0);
  for (int i = 1; i <= 3; ++i) {
    const auto run = run_program(folder, verify(files, {"--gap", "--second-opinion", "--shard", fmt::format("{}/3", i),
                                                        "--json", shards / fmt::format("{}.json", i)}));
    ASSERT_EQ(run.exit_code, 0) << run.err;
    EXPECT_TRUE(run.out.starts_with("clean (a part: frames ")) << run.out;
  }
  for (int again = 0; again < 2; ++again) {  // the second time the folder holds the result of the first
    const auto run = run_program(folder, {"merge", shards, "-o", merged});
    EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
    EXPECT_TRUE(run.out.starts_with("clean\n")) << run.out;
    EXPECT_EQ(report(merged), report(whole));
  }
  EXPECT_EQ(report(whole)["second_opinion"]["disagreed"], 0);
  EXPECT_GT(report(whole)["gap"]["lower"], 0);
  std::filesystem::remove(merged);
  std::filesystem::rename(shards / "2.json", folder.path() / "2.json");
  const auto missing = run_program(folder, {"merge", shards, "-o", merged});
  EXPECT_EQ(missing.exit_code, 3) << missing.out;
  EXPECT_EQ(missing.out, "");
  EXPECT_NE(missing.err.find("no part holds frames 3 to 4"), std::string::npos) << missing.err;
  EXPECT_FALSE(std::filesystem::exists(merged));
  EXPECT_EQ(run_program(folder, {"merge", shards / "1.json", shards / "1.json", "-o", merged}).exit_code, 3);
  spit(shards / "2.json", "{}");
  EXPECT_EQ(run_program(folder, {"merge", shards, "-o", merged}).exit_code, 3) << "not a report";
  ASSERT_EQ(
      run_program(folder, verify(files, {"--shard", "2/3", "--min-distance", "0.01", "--json", shards / "2.json"}))
          .exit_code,
      0);
  EXPECT_EQ(run_program(folder, {"merge", shards, "-o", merged}).exit_code, 3) << "other options";
}

TEST(LongRuns, WhatDoesNotFitTogetherIsNamedWithARemedy) {
  const TemporaryFolder folder;
  const auto files = sequence(folder.path(), 4, 2);
  const auto shard = [&](const char* part, const char* name, std::vector<std::string> options) {
    options.insert(options.end(), {"--shard", part, "--json", folder.path() / name});
    ASSERT_EQ(run_program(folder, verify(files, options)).exit_code, 0);
  };
  shard("1/2", "first.json", {});
  shard("2/2", "second.json", {});
  shard("2/2", "far.json", {"--min-distance", "0.01"});
  shard("2/2", "gap.json", {"--gap"});
  shard("2/2", "few.json", {"--max-violations", "7"});
  ASSERT_TRUE(std::filesystem::create_directory(folder.path() / "other"));
  auto others = files;
  others[2] = folder.path() / "other" / "good_2.obj";
  std::filesystem::copy(files[2], others[2]);
  ASSERT_EQ(run_program(folder, verify(others, {"--shard", "2/2", "--json", folder.path() / "other.json"})).exit_code,
            0);
  const struct {
    std::vector<std::string> reports;
    const char *what, *remedy;
  } cases[] = {
      {{"first.json", "far.json"}, "options.min_distance differ: \"none\" and \"0x1.47ae", "with the same options"},
      {{"first.json", "gap.json"}, "options.gap differ: \"no\" and \"yes\"; ", "with the same options"},
      {{"first.json", "few.json"}, "--max-violations differ: 100 and 7; ", "with the same options"},
      {{"first.json", "other.json"}, "good_2.obj; ", "run every shard on the same files"},
      {{"first.json"}, "no part holds frames 2 to 3; ", "run that shard (selvage verify --shard i/N)"},
      {{"first.json", "first.json"}, "both hold frames 0 to 1; ", "name shards of one N, and each once"},
      {{"none"}, "holds no report (*.json); ", "selvage verify --shard i/N --json FILE"},
  };
  std::filesystem::create_directory(folder.path() / "none");
  for (const auto& c : cases) {
    std::vector<std::string> arguments = {"merge", "-o", folder.path() / "m.json"};
    for (const std::string& report : c.reports) arguments.push_back(folder.path() / report);
    const auto result = run_program(folder, arguments);
    EXPECT_EQ(result.exit_code, 3) << c.what;
    EXPECT_NE(result.err.find(c.what), std::string::npos) << result.err;
    EXPECT_NE(result.err.find(c.remedy), std::string::npos) << result.err;
  }
}

TEST(LongRuns, AShardIsNamedByHandOrBySlurm) {
  const TemporaryFolder folder;
  const auto files = sequence(folder.path(), 4, 2);
  const auto json = folder.path() / "r.json";
  for (const char* bad : {"0/2", "3/2", "1", "1/0", "x/2", "1/2/3", "1/5", "auto"}) {
    EXPECT_EQ(run_program(folder, verify(files, {"--shard", bad})).exit_code, 2) << bad;
  }
  const auto slurm = [](const char* id, const char* first, const char* last, const char* count) {
    setenv("SLURM_ARRAY_TASK_ID", id, 1);
    setenv("SLURM_ARRAY_TASK_MIN", first, 1);
    setenv("SLURM_ARRAY_TASK_MAX", last, 1);
    setenv("SLURM_ARRAY_TASK_COUNT", count, 1);
  };
  slurm("6", "5", "6", "2");
  EXPECT_EQ(run_program(folder, verify(files, {"--shard", "auto", "--json", json})).exit_code, 0);
  EXPECT_EQ(report(json)["sequence"]["first_frame"], 2);
  EXPECT_EQ(report(json)["sequence"]["end_frame"], 4);
  EXPECT_EQ(report(json)["motions"]["checked"], 2) << "the motion from the frame before belongs to the shard";
  slurm("7", "5", "7", "2");  // tasks 5 and 7: which shards would they be?
  EXPECT_EQ(run_program(folder, verify(files, {"--shard", "auto"})).exit_code, 2);
  for (const char* name : {"_ID", "_MIN", "_MAX", "_COUNT"}) unsetenv((std::string("SLURM_ARRAY_TASK") + name).c_str());
}

TEST(LongRuns, AKilledRunIsResumed) {
  const TemporaryFolder folder;
  const auto once = sequence(folder.path(), 60, 40);
  const auto json = folder.path() / "r.json", whole = folder.path() / "whole.json",
             progress = folder.path() / "r.json.progress";
  ASSERT_EQ(run_program(folder, verify(once, {"--json", whole, "--threads", "1"})).exit_code, 0);
  // Progress is written every second: the files over and over, until there is time for it on the fastest machine.
  const auto seconds = nlohmann::json::parse(slurp(whole))["seconds"].get<double>();
  std::vector<std::string> files;
  for (double planned = 0; planned < 3; planned += seconds) files.insert(files.end(), once.begin(), once.end());
  ASSERT_EQ(run_program(folder, verify(files, {"--json", whole})).exit_code, 0);
  const auto arguments = verify(files, {"--json", json, "--resume", "--threads", "1"});
  const pid_t child = testing::start_program(folder.path(), arguments);
  int status = 0;
  while (!std::filesystem::exists(progress) && waitpid(child, &status, WNOHANG) == 0) usleep(2000);
  kill(child, SIGKILL);
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status)) << "it was over before it could be killed";
  EXPECT_FALSE(std::filesystem::exists(json));
  const auto done = report(progress)["frames"]["checked"].get<int>();
  EXPECT_GT(done, 0);
  EXPECT_LT(done, static_cast<int>(files.size()));

  spit(folder.path() / "other.txt", slurp(progress));
  EXPECT_EQ(run_program(folder, verify(files, {"--json", json, "--resume", "--weld"})).exit_code, 2) << "other options";
  const auto resumed = run_program(folder, arguments);
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err;
  EXPECT_EQ(report(json), report(whole));
  EXPECT_FALSE(std::filesystem::exists(progress));
  EXPECT_EQ(run_program(folder, arguments).exit_code, 0) << "a finished run is not done again, and says the same";
  EXPECT_EQ(report(json), report(whole));

  spit(progress, slurp(folder.path() / "other.txt"));
  spit(files[static_cast<std::size_t>(done) - 1], sheet(40, 77));  // the last frame that was checked
  const auto changed = run_program(folder, arguments);
  EXPECT_EQ(changed.exit_code, 3) << changed.out;
  EXPECT_NE(changed.err.find("start anew"), std::string::npos) << changed.err;
}

TEST(LongRuns, AFrameThatCannotBeReadDoesNotCostThoseBefore) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = sequence(folder.path(), 4, 5);
  const auto run = folder.path() / "run", third = run / "frame_000002.npy", json = folder.path() / "r.json";
  arguments.insert(arguments.begin(), "convert");
  arguments.insert(arguments.end(), {"-o", run});
  ASSERT_EQ(run_program(folder, arguments).exit_code, 0);
  const std::string bytes = slurp(third);
  spit(third, bytes.substr(0, bytes.size() - 1));
  const auto refused = run_program(folder, {"verify", run, "--json", json});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("r.json.progress; --resume goes on from there"), std::string::npos) << refused.err;
  spit(third, bytes);
  const auto other = run_program(folder, {"verify", run, "--json", json, "--resume", "--max-violations", "7"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_NE(other.err.find("r.json.progress: lists 100 violations at most"), std::string::npos) << other.err;
  const auto part = run_program(folder, {"verify", run, "--json", json, "--resume", "--shard", "1/2"});
  EXPECT_EQ(part.exit_code, 2);
  EXPECT_NE(part.err.find("r.json.progress: is about frames 0 to 3, not 0 to 1"), std::string::npos) << part.err;
  std::filesystem::copy(json.string() + ".progress", folder.path() / "s.json.progress");
  arguments = sequence(folder.path(), 3, 5);
  arguments.insert(arguments.begin(), "verify");
  arguments.insert(arguments.end(), {"--json", folder.path() / "s.json", "--resume"});
  const auto elsewhere = run_program(folder, arguments);
  EXPECT_EQ(elsewhere.exit_code, 3);
  EXPECT_NE(elsewhere.err.find("s.json.progress: is of another sequence"), std::string::npos) << elsewhere.err;
  EXPECT_EQ(run_program(folder, {"verify", run, "--json", json, "--resume"}).exit_code, 0);
  EXPECT_EQ(report(json)["frames"]["checked"], 4);
  spit(run / "frame_000000.npy", "");
  const auto first = run_program(folder, {"verify", run, "--json", folder.path() / "other.json"});
  EXPECT_EQ(first.exit_code, 3);
  EXPECT_EQ(first.err.find("--resume"), std::string::npos) << "nothing was checked: " << first.err;
}

TEST(LongRuns, AnInterruptedRunIsResumed) {
  const TemporaryFolder folder;
  const auto files = sequence(folder.path(), 60, 40);
  const auto json = folder.path() / "r.json", whole = folder.path() / "whole.json";
  ASSERT_EQ(run_program(folder, verify(files, {"--json", whole})).exit_code, 0);
  const auto arguments = verify(files, {"--json", json, "--resume", "--threads", "1"});
  const pid_t child = testing::start_program(folder.path(), arguments);
  testing::wait_until_signal_is_caught(child, SIGTERM);
  kill(child, SIGTERM);
  EXPECT_EQ(testing::wait_for_program(folder.path(), child).exit_code, 75);
  EXPECT_EQ(report(json)["verdict"], "unknown");
  EXPECT_EQ(run_program(folder, arguments).exit_code, 0);
  EXPECT_EQ(report(json), report(whole));
}

}  // namespace selvage
