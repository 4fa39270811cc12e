// The conformance test of collision code: what misbehaves is named, what misses is found and made simple, and our own
// kernel passes.
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "fuzz/case_file.h"
#include "fuzz/shrink_query.h"
#include "tests/cli/run_program.h"

namespace selvage::fuzz {
namespace {

using testing::run_program;
using testing::slurp;
using testing::TemporaryFolder;

/// The kinds of failure in the report.
std::set<std::string> failures_of(const std::string& plugin, const std::vector<std::string>& more, int exit_code) {
  const TemporaryFolder folder;
  const std::filesystem::path artifacts = folder.path() / "artifacts";
  std::vector<std::string> arguments{"fuzz", "--plugin", plugin, "--jobs", "1", "--artifacts", artifacts.string()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const auto run = run_program(folder, arguments);
  EXPECT_EQ(run.exit_code, exit_code) << run.out << run.err;
  std::set<std::string> failures;
  const auto report = nlohmann::json::parse(slurp(artifacts / "conformance.json"));
  for (const auto& finding : report.at("findings")) failures.insert(finding.at("failure").get<std::string>());
  return failures;
}

TEST(Plugin, MisdeedsAreNamed) {
  const std::pair<const char*, const char*> kBad[] = {{"hangs", "hung"},
                                                      {"crashes", "crashed-SIGSEGV"},
                                                      {"writes_out_of_bounds", "wrote-out-of-bounds"},
                                                      {"gives_no_verdict", "invalid-verdict"},
                                                      {"changes_rounding", "changed-rounding-mode"},
                                                      {"sets_ftz", "set-flush-to-zero"}};
  for (const auto& [plugin, failure] : kBad) {
    const std::string library = std::string(SELVAGE_BAD_PLUGINS) + "/plugin_" + plugin + ".so";
    const auto failures = failures_of(library, {"--time", "0.2s", "--case-time", "0.4"}, 1);
    EXPECT_EQ(failures, std::set<std::string>{failure}) << plugin;
  }
}

TEST(Plugin, TheTextbookMissesAndTheMissIsMadeSimple) {
  const TemporaryFolder folder;
  const std::filesystem::path artifacts = folder.path() / "artifacts";
  const auto run = run_program(folder, {"fuzz", "--plugin", SELVAGE_TEXTBOOK_PLUGIN, "--cases", "1", "--jobs", "1",
                                        "--artifacts", artifacts.string()});
  EXPECT_EQ(run.exit_code, 1) << run.err;
  int fewest = 24;
  for (const std::filesystem::path& file : case_files(artifacts)) {
    if (file.string().find("missed") == std::string::npos) continue;
    const Case kept = read_case(file);
    EXPECT_TRUE(kept.touches) << file;
    fewest = std::min(fewest, cost_of(kept.query).non_zero);
  }
  EXPECT_LE(fewest, 12);
}

TEST(Plugin, TheKernelConforms) { EXPECT_EQ(failures_of(SELVAGE_KERNEL_PLUGIN, {"--cases", "1"}, 0).size(), 0U); }

TEST(Plugin, WhatIsNoPluginIsRefused) {
  const TemporaryFolder folder;
  const auto run = run_program(folder, {"fuzz", "--plugin", SELVAGE_PROGRAM});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("cannot be loaded"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace selvage::fuzz
