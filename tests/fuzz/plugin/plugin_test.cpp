// The conformance test of collision code: what misbehaves is named, what misses is found and made simple, and our own
// kernel passes.
#include <csignal>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <oneapi/tbb/global_control.h>

#include "fuzz/kept/case_file.h"
#include "fuzz/plugin/conformance.h"
#include "fuzz/run/driver.h"
#include "fuzz/shrink/shrink_query.h"
#include "tests/cli/run_program.h"

namespace selvage::fuzz {
namespace {

using testing::run_program;
using testing::slurp;
using testing::TemporaryFolder;

std::string bad_plugin(const std::string& misdeed) {
  return std::string(SELVAGE_BAD_PLUGINS) + "/plugin_" + misdeed + ".so";
}

/// The kinds of failure that a campaign with one work unit finds.
std::set<std::string> failures_of(const std::string& plugin) {
  const TemporaryFolder folder;
  DriverOptions options;
  options.folder = folder.path();
  options.cases = 1;
  options.case_seconds = 0.4;
  Properties properties;
  properties.push_back(
      make_conformance(plugin, crc32_of_plugin(plugin), probe_plugin(plugin, options.case_seconds).gap));
  Driver driver(properties, options);
  EXPECT_TRUE(driver.run([] { return false; }, [](const DriverStatus&) {}));
  std::set<std::string> failures;
  for (const auto& [key, finding] : driver.ledger().properties.front().findings) failures.insert(key.second);
  return failures;
}

// In one process, because half of what a campaign costs under the sanitizers is the recorded scene, made once a
// process.
TEST(Plugin, MisdeedsAreNamed) {
  // Drivers fork, and between two of them oneTBB would start threads.
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const std::pair<const char*, const char*> kBad[] = {{"hangs", "hung"},
                                                      {"crashes", "crashed-SIGSEGV"},
                                                      {"writes_out_of_bounds", "wrote-out-of-bounds"},
                                                      {"gives_no_verdict", "invalid-verdict"},
                                                      {"changes_rounding", "changed-rounding-mode"},
                                                      {"sets_ftz", "set-flush-to-zero"},
                                                      {"answers_all_like_the_first", "batch-differs"},
                                                      {"forgets_later_lanes", "batch-differs"},
                                                      {"forgets_the_last", "batch-differs"},
                                                      {"repeats_a_vector", "batch-differs"},
                                                      {"writes_whole_vectors", "wrote-out-of-bounds"},
                                                      {"answers_at_least_one", "wrote-out-of-bounds"},
                                                      {"has_room_for_a_hundred", "batch-differs"},
                                                      {"alarms_a_quarter_too_far", "alarm-too-far"},
                                                      {"writes_to_files", "broke-the-channel"},
                                                      {"invents_failures", "broke-the-channel"},
                                                      {"closes_files", "exited"},
                                                      {"forbids_files", "missed"},
                                                      {"forks", "forked"},
                                                      {"sleeps", "hung"},
                                                      {"exits", "exited"},
                                                      {"throws", "threw"},
                                                      {"unmasks_fp_errors", "crashed-SIGFPE"},
                                                      {"gives_no_time", "invalid-time"}};
  for (const auto& [plugin, failure] : kBad) {
    const std::string library = bad_plugin(plugin);
    EXPECT_EQ(failures_of(library), std::set<std::string>{failure}) << plugin;
  }
}

TEST(Plugin, TheSmallestExampleConforms) {
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(failures_of(SELVAGE_BOXES_PLUGIN), std::set<std::string>{});
}

// What fails in a long batch is kept with the shortest in which it does, and replayed so.
TEST(Plugin, ABatchIsMadeShorter) {
  const TemporaryFolder folder;
  const std::filesystem::path artifacts = folder.path() / "artifacts";
  const std::string library = bad_plugin("has_room_for_a_hundred");
  const auto run =
      run_program(folder, {"fuzz", "--plugin", library, "--cases", "1", "--jobs", "1", "--artifacts", artifacts});
  EXPECT_EQ(run.exit_code, 1) << run.err;
  const auto files = case_files(artifacts);
  ASSERT_FALSE(files.empty());
  for (const std::filesystem::path& file : files) EXPECT_EQ(read_case(file).plugin->batch, 127) << file;
  const auto replayed = run_program(folder, {"replay", "--plugin", library, files[0]});
  EXPECT_EQ(replayed.exit_code, 1) << replayed.err;
  EXPECT_NE(replayed.out.find("FAILS: batch-differs\n            query 1"), replayed.out.npos) << replayed.out;
  EXPECT_NE(replayed.out.find(" of 127 ("), replayed.out.npos) << replayed.out;
}

// One that takes milliseconds, as in rational numbers, must not be called hung for what many answers take together.
TEST(Plugin, SlowAnswersAreTimedOneByOneAndNotAskedByTheThousand) {
  const MotionQuery at_rest;
  Plugin plugin(bad_plugin("naps"));
  int asked = 0;
  plugin.before_asking([&] { ++asked; });
  EXPECT_EQ(plugin.ask(at_rest, 21).misdeed, "");
  EXPECT_EQ(asked, 6) << "five alone, and a batch";
  EXPECT_EQ(plugin.ask(at_rest, 1025).misdeed, "");
  EXPECT_EQ(asked, 11) << "a batch of two seconds";
}

/// The first text between `begin` and `end`.
std::string between(const std::string& html, const std::string& begin, const std::string& end) {
  const std::size_t from = html.find(begin);
  if (from == html.npos) return {};
  return html.substr(from + begin.size(), html.find(end, from + begin.size()) - from - begin.size());
}

void expect_whole_page(const std::string& html, const nlohmann::json& report, const std::filesystem::path& artifacts) {
  for (const char* loads : {"src=", "url(", "@import", "http:", "https:", "<script>"}) {
    EXPECT_EQ(html.find(loads), html.npos) << loads;
  }
  EXPECT_EQ(nlohmann::json::parse(between(html, "id=\"report\">", "</script>")), report);
  const std::string table = between(html, "<table id=\"classes\">", "</table>");
  for (const auto& one : report["classes"]) {
    const std::string name = one["name"];
    EXPECT_NE(table.find(">" + name + "<"), table.npos) << name;
  }
  const std::string list = between(html, "<section id=\"findings\">", "</section>");
  for (const auto& one : report["findings"]) {
    EXPECT_NE(list.find(slurp(artifacts / one["smallest"])), list.npos) << one["smallest"];
  }
}

TEST(Plugin, TheTextbookMissesAndTheMissIsMadeSimpleAndShown) {
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
    const std::array<Vec3, 4>& x = kept.query.x_t0;
    EXPECT_FALSE(x[0] == x[1] && x[1] == x[2] && x[2] == x[3] && x == kept.query.x_t1)
        << file << ": four points in one place at rest, which no class draws";
    fewest = std::min(fewest, cost_of(kept.query).non_zero);
  }
  EXPECT_LE(fewest, 12);

  const std::string html = slurp(artifacts / "conformance.html");
  EXPECT_EQ(between(html, "<h1 id=\"verdict\">", "<"), "textbook: does not conform");
  expect_whole_page(html, nlohmann::json::parse(slurp(artifacts / "conformance.json")), artifacts);
  // The commands of the page do what it says.
  const std::string gravest = between(html, "<article>", "</article>");
  EXPECT_EQ(between(gravest, "<h3>", "<"), "contact missed");
  EXPECT_NE(gravest.find("# answered: separated"), gravest.npos) << gravest;
  std::istringstream command(between(gravest, "selvage replay ", "<"));
  std::vector<std::string> words{"replay"};
  for (std::string word; command >> word;) words.push_back(word);
  ASSERT_EQ(words.size(), 4U);
  const auto replayed = run_program(folder, words);
  EXPECT_EQ(replayed.exit_code, 1) << replayed.err;
  EXPECT_NE(replayed.out.find("  plugin:   textbook: separated: FAILS: missed\n"), replayed.out.npos) << replayed.out;
  EXPECT_NE(replayed.out.find("A PROMISE IS BROKEN (by the plugin: missed)\n"), replayed.out.npos) << replayed.out;
  const auto unasked = run_program(folder, {"replay", words[3]});
  EXPECT_EQ(unasked.exit_code, 0) << unasked.err;
  EXPECT_NE(unasked.out.find(SELVAGE_TEXTBOOK_PLUGIN " failed with 'missed' when this was kept"), unasked.out.npos);
  EXPECT_NE(unasked.out.find("ask it with: selvage replay --plugin " SELVAGE_TEXTBOOK_PLUGIN " " + words[3] + "\n"),
            unasked.out.npos)
      << unasked.out;
  EXPECT_NE(unasked.out.find("no promise is broken by Selvage's own kernel\n"), unasked.out.npos) << unasked.out;
  const auto again =
      run_program(folder, {"fuzz", "--plugin", SELVAGE_TEXTBOOK_PLUGIN, "--only", between(gravest, "--only ", "<")});
  EXPECT_EQ(again.exit_code, 1) << again.err;
  EXPECT_NE(again.out.find(": missed, case "), again.out.npos) << again.out;
  EXPECT_NE(again.out.find("  touches: 1, alarms: 0, missed: 1, late: 0,"), again.out.npos) << again.out;
  EXPECT_NE(again.out.find("FAILS: missed\n"), again.out.npos) << again.out;
}

TEST(Plugin, TheKernelConformsAndItsPageSaysSo) {
  const TemporaryFolder folder;
  const std::filesystem::path artifacts = folder.path() / "artifacts";
  const auto run = run_program(folder, {"fuzz", "--plugin", SELVAGE_KERNEL_PLUGIN, "--cases", "1", "--jobs", "1",
                                        "--artifacts", artifacts.string()});
  EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
  const std::string html = slurp(artifacts / "conformance.html");
  EXPECT_EQ(between(html, "<h1 id=\"verdict\">", "<"), "selvage kernel: nothing found");
  EXPECT_EQ(html.find("<article>"), html.npos);
  const auto accuracy = nlohmann::json::parse(slurp(artifacts / "conformance.json"))["accuracy"];
  EXPECT_EQ(accuracy["apart"][0]["alarms"], 0);
  EXPECT_LE(accuracy["early_at_most"]["of_the_step"]["half"], 0x1p-40);
}

// It keeps what it declares, which is nothing: the report must show it.
TEST(Plugin, AnAbsurdToleranceShowsInTheReport) {
  const TemporaryFolder folder;
  const std::filesystem::path artifacts = folder.path() / "artifacts";
  const auto run = run_program(folder, {"fuzz", "--plugin", bad_plugin("calls_all_collisions"), "--cases", "1",
                                        "--jobs", "1", "--artifacts", artifacts.string()});
  EXPECT_EQ(run.exit_code, 0) << run.out << run.err;
  EXPECT_NE(run.out.find(" 100 %\n"), run.out.npos) << run.out;
  const auto report = nlohmann::json::parse(slurp(artifacts / "conformance.json"));
  const auto& far = report["accuracy"]["apart"][0];
  EXPECT_EQ(far["beyond"], 0x1p-10);
  EXPECT_GT(far["cases"], 100);
  EXPECT_EQ(far["alarms"], far["cases"]);
  const auto& early = report["accuracy"]["early_at_most"];
  EXPECT_EQ(early["of_the_step"]["worst"], 1);
  EXPECT_GE(early["of_the_step"]["half"], 0.25);
  EXPECT_GE(early["of_the_size"]["half"], 0x1p-6);
  std::int64_t times = 0;
  for (const auto& one : report["classes"]) times += one["accuracy"]["times"].get<std::int64_t>();
  EXPECT_EQ(report["accuracy"]["times"], times);
  EXPECT_GT(times, 10);
  const std::string html = slurp(artifacts / "conformance.html");
  EXPECT_NE(html.find("100 % of what stays apart by more than 2^-10 of the size"), html.npos);
}

TEST(Plugin, OneCaseIsRunInAProcessOfItsOwn) {
  const TemporaryFolder folder;
  const std::pair<const char*, const char*> kBad[] = {{"crashes", "crashed-SIGSEGV"},
                                                      {"exits", "exited"},
                                                      {"throws", "threw"},
                                                      {"sleeps", "hung"},
                                                      {"gives_no_time", "invalid-time"}};
  for (const auto& [plugin, failure] : kBad) {
    const std::string library = bad_plugin(plugin);
    const auto run = run_program(
        folder, {"fuzz", "--plugin", library, "--seed", "7", "--only", "lattice-ulp/vf:3", "--case-time", "0.3"});
    EXPECT_EQ(run.exit_code, 1) << plugin << run.err;
    EXPECT_TRUE(run.out.starts_with("promise tested by conformance: the plugin misses no contact")) << run.out;
    EXPECT_NE(run.out.find(std::string("  lattice-ulp vf: ") + failure + ", case 3 of seed 7\n"), run.out.npos)
        << run.out;
    EXPECT_EQ(run.out.find("a plugin says hello"), run.out.npos) << "among the results";
  }
}

// What no case can keep is not made simpler, and not called anything else.
TEST(Plugin, AnAnswerThatDependsOnEarlierOnesIsUnsteady) {
  const TemporaryFolder folder;
  std::string library;
  std::filesystem::path artifacts;
  nlohmann::json findings;
  for (const char* plugin : {"wavers", "keeps_its_last_answer", "remembers"}) {
    library = bad_plugin(plugin);
    artifacts = folder.path() / plugin;
    const auto run =
        run_program(folder, {"fuzz", "--plugin", library, "--cases", "1", "--jobs", "1", "--artifacts", artifacts});
    EXPECT_EQ(run.exit_code, 1) << plugin << run.err;
    findings = nlohmann::json::parse(slurp(artifacts / "conformance.json"))["findings"];
    ASSERT_FALSE(findings.empty()) << plugin;
    for (const auto& finding : findings) EXPECT_EQ(finding["failure"], "unsteady") << plugin << finding;
  }
  const auto replayed =
      run_program(folder, {"replay", "--plugin", library, artifacts / findings[0]["smallest"].get<std::string>()});
  EXPECT_EQ(replayed.exit_code, 0) << replayed.out << replayed.err;
  EXPECT_NE(replayed.out.find(
                "it was kept for 'unsteady': the library has changed since, or its answer depends on what it was"),
            replayed.out.npos)
      << replayed.out;
}

TEST(Plugin, WhatWasAskedNothingIsNotCleared) {
  const TemporaryFolder folder;
  const std::filesystem::path artifacts = folder.path() / "artifacts";
  const auto run = run_program(folder, {"fuzz", "--plugin", SELVAGE_KERNEL_PLUGIN, "--cases", "1", "--jobs", "1",
                                        "--shard", "2/2", "--artifacts", artifacts});
  EXPECT_EQ(run.exit_code, 5) << run.out << run.err;
  EXPECT_NE(run.out.find(" classes were asked nothing: nothing is known of them"), run.out.npos) << run.out;
  EXPECT_EQ(run.out.find("nothing found"), run.out.npos) << run.out;
  const auto report = nlohmann::json::parse(slurp(artifacts / "conformance.json"));
  EXPECT_EQ(report["classes_without_queries"], report["classes"].size());
  EXPECT_EQ(between(slurp(artifacts / "conformance.html"), "<h1 id=\"verdict\">", "<"), "selvage kernel: unknown");
}

TEST(Plugin, ReplayAsksAPluginAsACampaignDoes) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.case", overlap = folder.path() / "overlap.case", json = folder.path() / "r.json";
  testing::spit(file,
                "selvage-case 1 vf\nseed hand\noptions tolerance=0x0p+0 max_intervals=64\np 1 1 1  1 1 -1\n"
                "a 0 0 0  0 0 0\nb 4 0 0  4 0 0\nc 0 4 0  0 4 0\nexpect touches\n");
  testing::spit(overlap,
                "selvage-case 1 overlap\nseed hand\na 0 0 0 0\nb 1 4 0 0\nc 2 0 4 0\nd 3 1 1 1\ne 4 2 1 1\n"
                "f 5 1 2 1\nexpect apart\n");
  const auto replay = [&](const std::string& library, const std::filesystem::path& case_file) {
    return run_program(folder, {"replay", "--plugin", library, "--case-time", "0.3", "--json", json, case_file});
  };
  const std::pair<const char*, const char*> kBad[] = {{"crashes", "crashed-SIGSEGV"},
                                                      {"sleeps", "hung"},
                                                      {"sets_ftz", "set-flush-to-zero"},
                                                      {"gives_no_time", "invalid-time"},
                                                      {"answers_all_like_the_first", "batch-differs"}};
  for (const auto& [plugin, failure] : kBad) {
    const auto run = replay(bad_plugin(plugin), file);
    EXPECT_EQ(run.exit_code, 1) << plugin << run.err;
    EXPECT_NE(run.out.find(std::string("  plugin:   bad: no answer: FAILS: ") + failure + "\n"), run.out.npos)
        << run.out;
    EXPECT_EQ(nlohmann::json::parse(slurp(json))["cases"][0]["plugin"]["failure"], failure);
  }
  const auto conforms = replay(SELVAGE_KERNEL_PLUGIN, file);
  EXPECT_EQ(conforms.exit_code, 0) << conforms.out << conforms.err;
  EXPECT_NE(conforms.out.find("before the first touch: conforms\n"), conforms.out.npos) << conforms.out;
  EXPECT_EQ(replay(SELVAGE_PROGRAM, file).exit_code, 3);
  const auto asked_nothing = replay(SELVAGE_KERNEL_PLUGIN, overlap);
  EXPECT_EQ(asked_nothing.exit_code, 3);
  EXPECT_NE(asked_nothing.err.find("was asked nothing; name a case of vf or ee"), asked_nothing.err.npos);
}

TEST(Plugin, ANameIsCutBetweenCharactersAndHasNothingButCharacters) {
  EXPECT_STREQ(probe_plugin(bad_plugin("has_a_bad_name"), kCaseSeconds).name,
               "a??[31m ? ........ ........ ........ ........ ........ .......");
}

/// As a linker leaves another build: other bytes, the same name.
void rebuild(const std::filesystem::path& library) { testing::spit(library, slurp(library) + "rebuilt"); }

TEST(Plugin, ALibraryThatWasRebuiltIsAnotherCampaign) {
  const TemporaryFolder folder;
  const auto library = folder.path() / "plugin.so", artifacts = folder.path() / "artifacts";
  std::filesystem::copy_file(SELVAGE_KERNEL_PLUGIN, library);
  const std::vector<std::string> arguments = {"fuzz",   "--plugin", library,       "--cases", "1",
                                              "--jobs", "1",        "--artifacts", artifacts, "--resume"};
  EXPECT_EQ(run_program(folder, arguments).exit_code, 0);
  EXPECT_EQ(run_program(folder, arguments).exit_code, 0) << "the same library";
  const std::string ledger = slurp(artifacts / "campaign.json");
  EXPECT_EQ(nlohmann::json::parse(ledger)["plugin_crc32"], crc32_of_plugin(library));
  EXPECT_EQ(nlohmann::json::parse(slurp(artifacts / "conformance.json"))["plugin"]["crc32"], crc32_of_plugin(library));
  rebuild(library);
  const auto refused = run_program(folder, arguments);
  EXPECT_EQ(refused.exit_code, 3) << refused.out << refused.err;
  EXPECT_NE(refused.err.find("campaign.json: is of another library with the name 'plugin selvage kernel'"),
            refused.err.npos)
      << refused.err;
  EXPECT_EQ(slurp(artifacts / "campaign.json"), ledger);
}

TEST(Plugin, ALibraryThatIsRebuiltMeanwhileIsNotLoaded) {
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const TemporaryFolder folder;
  const auto library = folder.path() / "plugin.so";
  std::filesystem::copy_file(SELVAGE_KERNEL_PLUGIN, library);
  Properties properties;
  properties.push_back(make_conformance(library, crc32_of_plugin(library), DeclaredGap()));
  rebuild(library);
  DriverOptions options;
  options.folder = folder.path();
  options.cases = 1;
  options.plugin_crc32 = 0;
  Driver driver(properties, options);
  EXPECT_THROW((void)driver.run([] { return false; }, [](const DriverStatus&) {}), io::Error);
  EXPECT_NE(slurp(folder.path() / kWorkerLog).find("plugin.so: has changed since this began"), std::string::npos);
}

TEST(Plugin, PartsOfACampaignAreNotJoined) {
  const TemporaryFolder folder;
  std::vector<std::string> arguments = {"merge", "-o", folder.path() / "whole"};
  for (const std::string part : {"1/2", "2/2"}) {
    arguments.push_back(folder.path() / ("part-" + part.substr(0, 1)));
    const auto run = run_program(folder, {"fuzz", "--plugin", SELVAGE_KERNEL_PLUGIN, "--cases", "1", "--jobs", "1",
                                          "--shard", part, "--artifacts", arguments.back()});
    EXPECT_EQ(run.exit_code, part == "1/2" ? 0 : 5) << run.err;  // the second has nothing to do
  }
  const auto refused = run_program(folder, arguments);
  EXPECT_EQ(refused.exit_code, 3) << refused.out;
  EXPECT_NE(refused.err.find("campaign.json: is a campaign of collision code under --plugin (plugin selvage kernel), "
                             "and those are not joined; read the report of each shard"),
            refused.err.npos)
      << refused.err;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "whole"));
}

TEST(Plugin, LoadingMayTakeAsLongAsACase) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.case";
  testing::spit(file,
                "selvage-case 1 vf\nseed hand\noptions tolerance=0x0p+0 max_intervals=64\np 1 1 1  1 1 -1\n"
                "a 0 0 0  0 0 0\nb 4 0 0  4 0 0\nc 0 4 0  0 4 0\nexpect touches\n");
  const std::string at_load = bad_plugin("hangs_at_load"), in_workers = bad_plugin("hangs_in_workers");
  const std::string artifacts = folder.path() / "artifacts";
  const std::pair<std::vector<std::string>, std::string> kRuns[] = {
      {{"fuzz", "--plugin", at_load, "--cases", "1", "--artifacts", artifacts},
       at_load + ": does not survive being loaded: hung; give it more time with --case-time"},
      {{"replay", "--plugin", at_load, file}, at_load + ": does not survive being loaded: hung; give it more time"},
      {{"fuzz", "--plugin", in_workers, "--cases", "1", "--artifacts", artifacts},
       "plugin bad: a worker hung before it could run a case"}};
  for (auto [arguments, words] : kRuns) {
    arguments.insert(arguments.end(), {"--case-time", "0.3"});
    const auto run = run_program(folder, arguments);
    EXPECT_EQ(run.exit_code, 3) << run.out << run.err;
    EXPECT_NE(run.err.find(words), run.err.npos) << run.err;
  }
}

/// A campaign with a plugin that does not come back, once its worker has printed `words`.
pid_t start_stuck(const TemporaryFolder& folder, const std::string& misdeed, const std::string& case_time,
                  const std::string& words) {
  const auto artifacts = folder.path() / "artifacts";
  const pid_t child =
      testing::start_program(folder.path(), {"fuzz", "--plugin", bad_plugin(misdeed), "--cases", "1", "--case-time",
                                             case_time, "--jobs", "1", "--artifacts", artifacts});
  const auto has_come = [&] { return slurp(artifacts / kWorkerLog).find(words) != std::string::npos; };
  for (int i = 0; i < 6000 && !has_come(); ++i) usleep(10000);
  EXPECT_TRUE(has_come());
  return child;
}

// The terminal signals the whole group, and a launcher passes on what it gets.
TEST(Plugin, TwoSignalsAtOnceAreOneRequest) {
  const TemporaryFolder folder;
  const pid_t child = start_stuck(folder, "sleeps", "2", "a plugin falls asleep");
  for (int i = 0; i < 2; ++i) {
    kill(child, SIGTERM);
    testing::wait_until_signal_is_taken(child, SIGTERM);
  }
  const auto result = testing::wait_for_program(folder.path(), child);
  EXPECT_EQ(result.exit_code, 75) << result.out << result.err;
}

TEST(Plugin, ALaterSecondSignalEndsAtOnce) {
  const TemporaryFolder folder;
  const pid_t child = start_stuck(folder, "sleeps", "600", "a plugin falls asleep");
  int status = 0;
  pid_t ended = 0;
  for (int i = 0; i < 100 && ended == 0; ++i) {  // the first asks; one that comes half a second after it kills
    kill(child, i % 2 == 0 ? SIGTERM : SIGINT);
    usleep(600'000);
    ended = waitpid(child, &status, WNOHANG);
  }
  ASSERT_EQ(ended, child);
  EXPECT_TRUE(WIFSIGNALED(status));
}

TEST(Plugin, ASignalEndsAWorkerThatStillLoads) {
  const TemporaryFolder folder;
  const pid_t child = start_stuck(folder, "hangs_in_workers", "600", "a plugin says hello");
  kill(child, SIGTERM);
  const auto result = testing::wait_for_program(folder.path(), child);
  EXPECT_EQ(result.exit_code, 75) << result.out << result.err;
}

TEST(Plugin, WhatIsNoPluginIsRefused) {
  const TemporaryFolder folder;
  const auto run = run_program(folder, {"fuzz", "--plugin", SELVAGE_PROGRAM});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_NE(run.err.find("cannot be loaded"), std::string::npos) << run.err;
  EXPECT_EQ(run_program(folder, {"fuzz", "--plugin", (folder.path() / "absent.so").string()}).exit_code, 4);
  const std::pair<const char*, const char*> kUnfit[] = {
      {"exits_at_load", "does not survive being loaded: exited"},
      {"throws_at_load", "throws from selvage_plugin_entry: no licence"},
      {"is_of_another_version", "is built for version 2 of selvage-plugin.h, this is version 1"},
      {"has_another_entry", "has no function selvage_plugin_entry"}};
  for (const auto& [plugin, words] : kUnfit) {
    const std::string library = bad_plugin(plugin);
    const auto refused = run_program(folder, {"fuzz", "--plugin", library, "--artifacts", folder.path() / "artifacts"});
    EXPECT_EQ(refused.exit_code, 3) << plugin;
    EXPECT_NE(refused.err.find(library + ": " + words), std::string::npos) << refused.err;
  }
}

}  // namespace
}  // namespace selvage::fuzz
