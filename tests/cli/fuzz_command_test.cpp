// Campaigns as the command runs them: how they end.
#include <csignal>

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
