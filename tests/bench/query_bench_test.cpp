#include "bench/query_bench.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/public_data.h"

namespace selvage::bench {
namespace {

/// Point (x, y) falling from z = 1 to z = `end_z` above the triangle (0,0) (1,0) (0,1).
io::CcdQuery falling_point(double x, double y, double end_z, std::optional<bool> truth) {
  return {{{{x, y, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {x, y, end_z}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}, truth};
}

TEST(QueryBench, KindComesFromTheNamesOfThePublicSets) {
  EXPECT_EQ(kind_of_path("a/vertex-face/data_0_0.csv"), PairKind::kVf);
  EXPECT_EQ(kind_of_path("a/edge-edge/data_0_0.csv"), PairKind::kEe);
  EXPECT_EQ(kind_of_path("rod-twist/queries/3036vf.csv"), PairKind::kVf);
  EXPECT_EQ(kind_of_path("3036ee.csv"), PairKind::kEe);
  EXPECT_EQ(kind_of_path("edge-edge/3036vf.csv"), PairKind::kVf);  // the file's own name is nearer
  EXPECT_EQ(kind_of_path("data.csv"), std::nullopt);
}

TEST(QueryBench, CountsWrongAnswersAgainstTheTruth) {
  // The second truth is a lie: every method must be charged with a false positive for it, the exact one too.
  const QueryFile file{"x",
                       PairKind::kVf,
                       {falling_point(0.25, 0.25, -1, true), falling_point(0.25, 0.25, -1, false),
                        falling_point(3, 3, -1, false), falling_point(3, 3, -1, true)}};
  const QueryBenchReport report = run_query_bench(std::span(&file, 1), {.tolerance = 0, .repeat = 1});
  EXPECT_EQ(report.queries, 4);
  EXPECT_EQ(report.positives, 2);
  EXPECT_EQ(report.truth_in_files, 4);
  ASSERT_EQ(report.methods.size(), 3U);
  for (const MethodReport& method : report.methods) {
    EXPECT_EQ(method.false_positives, 1) << method.name;
    EXPECT_EQ(method.false_negatives, 1) << method.name;
  }
}

TEST(QueryBench, TheExactCheckerSpeaksWhereFilesAreSilent) {
  const QueryFile file{
      "x", PairKind::kVf, {falling_point(0.25, 0.25, -1, std::nullopt), falling_point(0.25, 0.25, 0.5, std::nullopt)}};
  const QueryBenchReport report = run_query_bench(std::span(&file, 1), {.tolerance = 0, .repeat = 1});
  EXPECT_EQ(report.truth_in_files, 0);
  EXPECT_EQ(report.positives, 1);
}

TEST(QueryBench, ToleranceIsTheKernelsAlone) {
  const QueryFile file{"x", PairKind::kVf, {falling_point(0.25, 0.25, 0x1p-10, false)}};
  const QueryBenchReport report = run_query_bench(std::span(&file, 1), {.tolerance = 0x1p-9, .repeat = 1});
  EXPECT_EQ(report.methods[0].false_positives, 1);
  EXPECT_EQ(report.methods[1].false_positives, 0);
  EXPECT_EQ(report.methods[2].false_positives, 0);
}

TEST(QueryBench, AGuestIsJudgedLikeTheOthersUnderANameThatNoneOfThemHas) {
  // The last truth is a lie: what touches is no alarm beyond a gap, whatever the file says.
  const QueryFile file{"x",
                       PairKind::kVf,
                       {falling_point(0.25, 0.25, -1, true), falling_point(0.25, 0.25, -1, true),
                        falling_point(0.25, 0.25, 0.5, false), falling_point(0.25, 0.25, -1, false)}};
  GuestMethod<QueryTimes> guest;
  guest.facts.name = "kernel";
  guest.facts.has_toi = true;
  guest.answers = {{}, {true, false, 0.75}, {true}, {true, false, 0.25}};
  guest.is_beyond_gap = [](const MethodQuery&, const MethodAnswer&) { return true; };
  const QueryBenchReport report = run_query_bench(std::span(&file, 1), {.tolerance = 0, .repeat = 1}, guest);
  ASSERT_EQ(report.methods.size(), 4U);
  const MethodReport& judged = report.methods.back();
  EXPECT_EQ(judged.name, kGuestRow);
  EXPECT_EQ(judged.false_negatives, 1);
  EXPECT_EQ(judged.false_positives, 2);
  EXPECT_EQ(judged.false_positives_beyond_gap, 1);
  EXPECT_EQ(judged.toi.late, 1);
  EXPECT_TRUE(judged.is_unsafe());
  EXPECT_FALSE(report.methods.front().false_positives_beyond_gap.has_value());
}

TEST(QueryBench, TimesAreOrdered) {
  const QueryFile file{"x", PairKind::kVf, std::vector<io::CcdQuery>(200, falling_point(0.25, 0.25, -1, true))};
  for (const MethodReport& method : run_query_bench(std::span(&file, 1), {.tolerance = 0, .repeat = 2}).methods) {
    EXPECT_GT(method.ns.mean, 0) << method.name;
    EXPECT_LE(method.ns.median, method.ns.p99) << method.name;
    EXPECT_LE(method.ns.p99, method.ns.max) << method.name;
  }
}

TEST(QueryBench, JsonCarriesItsSchema) {
  const QueryFile file{"some.csv", PairKind::kVf, {falling_point(0.25, 0.25, -1, true)}};
  const auto json = nlohmann::json::parse(to_json(run_query_bench(std::span(&file, 1), {.tolerance = 0, .repeat = 1})));
  EXPECT_EQ(json.at("schema"), "selvage.bench.queries/1");
  EXPECT_EQ(json.at("files"), std::vector<std::string>{"some.csv"});
  EXPECT_EQ(json.at("queries"), 1);
  EXPECT_EQ(json.at("positives"), 1);
  for (const char* name : {"kernel", "textbook", "exact"}) {
    const auto& method = json.at("methods").at(name);
    for (const char* count : {"false_negatives", "false_positives", "late_toi"}) {
      EXPECT_TRUE(method.at(count).is_number_integer()) << count;
    }
    for (const char* time : {"mean", "median", "p99", "max"}) EXPECT_TRUE(method.at("ns").at(time).is_number()) << time;
  }
}

TEST(QueryBench, PublicQueriesAreAnsweredWithoutAMiss) {
  const auto data = testing::public_data();
  if (!data) GTEST_SKIP() << "no public data: set SELVAGE_DATA";
  std::vector<QueryFile> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(*data / "ccd" / "sample-queries")) {
    if (entry.path().extension() != ".csv") continue;
    const auto kind = kind_of_path(entry.path());
    ASSERT_TRUE(kind.has_value()) << entry.path();
    files.push_back({entry.path(), *kind, io::read_query_csv(entry.path())});
  }
  const QueryBenchReport report = run_query_bench(files, {.tolerance = 0, .repeat = 1});
  EXPECT_EQ(report.queries, 2500);
  EXPECT_EQ(report.truth_in_files, 2500);
  EXPECT_EQ(report.methods[0].false_negatives, 0);
  EXPECT_EQ(report.methods[0].toi.late, 0);
  EXPECT_EQ(report.methods[2].false_negatives, 0);
  EXPECT_EQ(report.methods[2].false_positives, 0);
}

}  // namespace
}  // namespace selvage::bench
