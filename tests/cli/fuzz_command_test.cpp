// Campaigns as the command runs them: how they end.
#include <algorithm>
#include <csignal>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/cli/run_program.h"

namespace selvage {

using testing::slurp;
using testing::TemporaryFolder;

namespace {

bool has_findings(const std::filesystem::path& ledger) {
  const std::string text = slurp(ledger);
  return !text.empty() && !nlohmann::json::parse(text)["properties"][0]["findings"].empty();
}

}  // namespace

TEST(FuzzCommand, AnInterruptedCampaignIs75WhateverItHasFound) {
  const TemporaryFolder folder;
  const auto artifacts = folder.path() / "artifacts";
  const pid_t child = testing::start_program(folder.path(), {"fuzz", "--plugin", SELVAGE_TEXTBOOK_PLUGIN, "--time",
                                                             "600s", "--jobs", "1", "--artifacts", artifacts});
  for (int i = 0; i < 6000 && !has_findings(artifacts / "campaign.json"); ++i) usleep(10000);
  kill(child, SIGTERM);
  const auto result = testing::wait_for_program(folder.path(), child);
  EXPECT_TRUE(has_findings(artifacts / "campaign.json"));
  EXPECT_EQ(result.exit_code, 75) << result.out << result.err;
}

// `timeout` and a scheduler signal the whole group.
TEST(FuzzCommand, ASignalToTheWorkersIsNoFinding) {
  const TemporaryFolder folder;
  const auto artifacts = folder.path() / "artifacts";
  const pid_t child =
      testing::start_program(folder.path(), {"fuzz", "ccd", "--time", "600s", "--jobs", "2", "--artifacts", artifacts});
  const std::string name = std::to_string(child);
  const auto lines = [&] { return std::ranges::count(slurp(artifacts / "stats.jsonl"), '\n'); };
  for (int i = 0; i < 6000 && lines() < 3; ++i) usleep(10000);  // a line a second, of work that is done
  std::ifstream children("/proc/" + name + "/task/" + name + "/children");
  int workers = 0;
  for (pid_t worker = 0; children >> worker; ++workers) kill(worker, SIGTERM);
  EXPECT_EQ(workers, 2);
  kill(child, SIGTERM);
  const auto result = testing::wait_for_program(folder.path(), child);
  EXPECT_EQ(result.exit_code, 75) << result.out << result.err;
  EXPECT_FALSE(has_findings(artifacts / "campaign.json")) << result.out;
}

TEST(FuzzCommand, ShardsThatDoNotFitTogetherAreNamedWithARemedy) {
  const TemporaryFolder folder;
  const auto shard = [&](const char* name, const char* part, const char* seed) {
    const std::filesystem::path artifacts = folder.path() / name;
    const auto run = testing::run_program(folder, {"fuzz", "ccd", "--cases", "1", "--jobs", "1", "--seed", seed,
                                                   "--shard", part, "--artifacts", artifacts});
    EXPECT_NE(slurp(artifacts / "campaign.json"), "") << run.err;
    return artifacts.string();
  };
  const std::string first = shard("first", "1/2", "1"), other = shard("other", "2/2", "7");
  const struct {
    std::vector<std::string> folders;
    const char* words;
  } cases[] = {{{first}, "shard 2/2 is missing; run it with --shard 2/2, and name its folder too"},
               {{first, first}, "shard 1 is there twice; name its folder once"},
               {{first, other}, "shards 1 and 2 differ in --seed; run every shard with the same options"}};
  for (const auto& c : cases) {
    std::vector<std::string> arguments = {"merge", "-o", folder.path() / "whole"};
    arguments.insert(arguments.end(), c.folders.begin(), c.folders.end());
    const auto result = testing::run_program(folder, arguments);
    EXPECT_EQ(result.exit_code, 3) << result.out;
    EXPECT_NE(result.err.find(c.words), std::string::npos) << result.err;
  }
}

TEST(FuzzCommand, WhatHadNoCaseIsNotCleared) {
  const TemporaryFolder folder;
  const auto shard = [&](const std::string& part) {
    return testing::run_program(folder, {"fuzz", "scale", "--cases", "1", "--jobs", "1", "--shard", part, "--artifacts",
                                         folder.path() / ("part" + part.substr(0, 1))});
  };
  const auto first = shard("1/2"), second = shard("2/2");
  EXPECT_EQ(first.exit_code, 0) << first.out << first.err;
  EXPECT_EQ(second.exit_code, 5) << second.out << second.err;
  EXPECT_NE(second.out.find(" streams have had no case: nothing is known of them"), std::string::npos) << second.out;
  EXPECT_NE(second.out.find(" 0/"), std::string::npos) << second.out;
  const auto merged = testing::run_program(
      folder, {"merge", folder.path() / "part1", folder.path() / "part2", "-o", folder.path() / "whole"});
  EXPECT_EQ(merged.exit_code, 0) << merged.out << merged.err;
}

TEST(FuzzCommand, AShardThatWasStoppedIsNoPartOfAWhole) {
  const TemporaryFolder folder;
  std::vector<std::string> merge = {"merge", "-o", folder.path() / "whole"};
  for (const std::string part : {"1", "2"}) {
    merge.push_back(folder.path() / part);
    testing::run_program(
        folder, {"fuzz", "scale", "--cases", "1", "--jobs", "1", "--shard", part + "/2", "--artifacts", merge.back()});
  }
  const std::filesystem::path ledger = folder.path() / "1" / "campaign.json";
  auto json = nlohmann::json::parse(slurp(ledger));
  json["properties"][0]["units"] =
      nlohmann::json::array();  // as of one that was stopped before its first unit was done
  testing::spit(ledger, json.dump());
  const auto merged = testing::run_program(folder, merge);
  EXPECT_EQ(merged.exit_code, 3) << merged.out;
  EXPECT_NE(merged.err.find("0 of 1 work units of scale are done; run the shards again with --resume"),
            std::string::npos)
      << merged.err;
}

TEST(FuzzCommand, AFindingOfSeveralShardsIsKeptFromItsLowestCase) {
  const TemporaryFolder folder;
  const auto shard = [&](const std::string& part, std::int64_t number) {
    const auto artifacts = folder.path() / ("part" + part.substr(0, 1)), ledger = artifacts / "campaign.json";
    testing::run_program(folder,
                         {"fuzz", "scale", "--cases", "1", "--jobs", "1", "--shard", part, "--artifacts", artifacts});
    auto json = nlohmann::json::parse(slurp(ledger));
    auto& property = json["properties"][0];
    property["streams"][0]["failures"] = 1;
    property["findings"] = {{{"stream", property["streams"][0]["name"]},
                             {"failure", "missed"},
                             {"count", 1},
                             {"case", number},
                             {"file", "scale.case"}}};
    testing::spit(ledger, json.dump());
    testing::spit(artifacts / "scale.case", "case " + std::to_string(number));
    return artifacts;
  };
  const auto lower = shard("1/2", 3), higher = shard("2/2", 8), whole = folder.path() / "whole";
  for (const auto& sources : {std::pair(lower, higher), std::pair(higher, lower)}) {
    const auto merged = testing::run_program(folder, {"merge", sources.first, sources.second, "-o", whole});
    EXPECT_EQ(merged.exit_code, 1) << merged.out << merged.err;
    EXPECT_EQ(slurp(whole / "scale.case"), "case 3");
  }
}

TEST(FuzzCommand, OurOwnKernelsAccuracyIsReported) {
  const TemporaryFolder folder;
  const auto artifacts = folder.path() / "artifacts";
  const auto result =
      testing::run_program(folder, {"fuzz", "ccd", "--cases", "1", "--jobs", "1", "--artifacts", artifacts});
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  EXPECT_NE(result.out.find("  how early times of impact are at most, of "), std::string::npos) << result.out;
  EXPECT_NE(result.out.find("  called a collision, of "), std::string::npos) << result.out;
  std::int64_t apart = 0, alarms = 0;
  const auto ledger = nlohmann::json::parse(slurp(artifacts / "campaign.json"));
  for (const auto& stream : ledger["properties"][0]["streams"]) {
    if (!stream.contains("accuracy")) continue;
    apart += stream["accuracy"]["apart"][0].get<std::int64_t>();
    alarms += stream["accuracy"]["alarms"][0].get<std::int64_t>();
  }
  EXPECT_GT(apart, 100);
  EXPECT_EQ(alarms, 0) << "apart by more than 2^-10 of the size";
}

// Scripts beyond float32 occur in the first cases: they must be refused, and nobody goes on from what is refused.
TEST(FuzzCommand, TheFirstCasesOfStepsAndSubdivisionHold) {
  for (const std::string property : {"step", "subdivision"}) {
    const TemporaryFolder folder;
    const std::string artifacts = folder.path() / "artifacts";
    const auto result =
        testing::run_program({"fuzz", property, "--cases", "60", "--jobs", "2", "--artifacts", artifacts});
    EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  }
}

}  // namespace selvage
