#include "bench/method_bench.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace selvage::bench {
namespace {

/// Point (x, y) falling from z = 1 to z = `end_z` above the triangle (0,0) (1,0) (0,1).
MethodQuery falling_point(double x, double y, double end_z) {
  std::array<Vec3, 4> x_t0{Vec3(x, y, 1), Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, x_t1 = x_t0;
  x_t1[0].z() = end_z;
  return method_query(PairKind::kVf, x_t0, x_t1);
}

const SettingReport& row(const SetReport& report, const std::string& method, const std::string& setting) {
  for (const SettingReport& of : report.settings) {
    if (of.method == method && of.setting == setting) return of;
  }
  throw std::logic_error("no row " + method + " " + setting);
}

TEST(MethodBench, CountsWhatEachMethodGetsWrong) {
  // Through the face, past it, and to 1e-4 above it: an alarm for tolerances above that, and for those alone.
  const QuerySet set{
      "three", "", {falling_point(0.25, 0.25, -1), falling_point(3, 3, -1), falling_point(0.25, 0.25, 1e-4)},
      nullptr, {}, {}};
  const SetReport report = run_method_bench(set, {.repeat = 2});
  EXPECT_EQ(report.vf, 3);
  EXPECT_EQ(report.touching, 1);
  for (const SettingReport& of : report.settings) EXPECT_EQ(of.misses, 0) << of.method;
  EXPECT_EQ(row(report, "kernel", "0.001 m").false_alarms, 1);
  EXPECT_EQ(row(report, "kernel", "0 m").false_alarms, 0);
  EXPECT_EQ(row(report, "textbook", "0.001 m").false_alarms, 1);
  EXPECT_EQ(row(report, "textbook", "1e-06 m").false_alarms, 0);
  EXPECT_EQ(row(report, "additive", "0.99").false_alarms, 1);
  EXPECT_EQ(row(report, "additive", "0.999").false_alarms, 1);
  EXPECT_EQ(row(report, "inclusion", "1e-06 of size").false_alarms, 0);
  EXPECT_EQ(row(report, "kernel", "0 m").toi_examined, 1);
  EXPECT_LE(row(report, "kernel", "0 m").toi.early_max, 1e-12);
  EXPECT_NEAR(row(report, "additive", "0.5").toi_off_p99, 0.25, 1e-12);
  EXPECT_NEAR(row(report, "additive", "0.5").toi.early_max, 0.25, 1e-12);  // half of the way to the touch at 1/2
  EXPECT_EQ(row(report, "textbook", "1e-06 m").ratio, 1);
  EXPECT_FALSE(breaks_promise(report));
}

TEST(MethodBench, AMissOfAMethodThatPromisesNoneIsSeen) {
  SetReport report;
  report.settings.push_back({"textbook", "1e-06 m", 5, 0, 0, 0, {}, 0, 1, 1});
  EXPECT_FALSE(breaks_promise(report));
  report.settings.push_back({"inclusion", "1e-06 of size", 1, 0, 0, 0, {}, 0, 1, 1});
  EXPECT_TRUE(breaks_promise(report));
  report.settings.back() = {"kernel", "0 m", 0, 0, 0, 0, {.late = 1}, 0, 1, 1};
  EXPECT_TRUE(breaks_promise(report));
}

TEST(MethodBench, BatchesAnswerTheQueriesOfTheirOwnCandidates) {
  const MeshMotion motion = crumpled_sheet(24);
  const QuerySet set = candidate_set("sheet", motion, 3000);
  EXPECT_EQ(set.queries.size(), set.place.size());
  EXPECT_LT(set.queries.size(), 4000U);
  EXPECT_GT(set.place.back(), set.candidates.vf.size() + 2000);
  const SetReport report = run_method_bench(set, {.repeat = 1});
  EXPECT_GT(report.touching, 20);
  const SettingReport &batch = row(report, "kernel in batches", "0 m"), &single = row(report, "kernel", "0 m");
  EXPECT_EQ(batch.misses, 0);
  EXPECT_EQ(batch.false_alarms, single.false_alarms);
  EXPECT_EQ(batch.toi.early_max, single.toi.early_max);  // the same bits, pair by pair
  EXPECT_EQ(batch.toi_examined, report.touching);
}

TEST(MethodBench, JsonCarriesItsSchema) {
  const QuerySet set{"one", "a point", {falling_point(0.25, 0.25, -1)}, nullptr, {}, {}};
  const SetReport report = run_method_bench(set, {.repeat = 1});
  const auto json = nlohmann::json::parse(to_json(std::span(&report, 1)));
  EXPECT_EQ(json.at("schema"), "selvage.bench.methods/1");
  EXPECT_EQ(json.at("baseline").at("method"), kBaselineMethod);
  const auto& of_set = json.at("sets").at(0);
  EXPECT_EQ(of_set.at("name"), "one");
  EXPECT_EQ(of_set.at("settings").size(), report.settings.size());
}

}  // namespace
}  // namespace selvage::bench
