#include <cmath>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "bench/stability/exact_watch.h"
#include "bench/stability/suite.h"

namespace selvage::bench {
namespace {

/// Two triangles above each other.
struct TwoTriangles {
  io::Triangles triangles{{0, 1, 2}, {3, 4, 5}};
  Positions x{6, 3};
  sim::CollisionStepReport report;

  TwoTriangles() {
    x << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.1, 0.1, 1, 0.9, 0.1, 1, 0.1, 0.9, 1;
    report.status = sim::StepStatus::kSafe;
  }
  Positions lowered(double by) const {
    Positions moved = x;
    moved.bottomRows(3).col(2).array() -= by;
    return moved;
  }
};

}  // namespace

TEST(StabilitySuite, EveryCasePassesInItsShortForm) {
  const std::vector<StabilityCase> cases = stability_cases();
  ASSERT_GE(cases.size(), 77U) << "as many as docs/measurements/stability.md lists";
  StabilityOptions options;
  options.quick = true;
  const auto reports = run_stability(cases, options);
  ASSERT_TRUE(reports);
  ASSERT_EQ(reports->size(), cases.size());
  for (const StabilityCaseReport& report : *reports) {
    EXPECT_EQ(report.trials.size(), 2u) << report.name;
    for (const TrialReport& trial : report.trials) EXPECT_EQ(trial.failure, "") << report.name;
  }
}

TEST(StabilitySuite, CasesHaveNamesOfTheirOwnAndSayWhatTheyAsk) {
  std::set<std::string> names;
  for (const StabilityCase& c : stability_cases()) {
    EXPECT_TRUE(names.insert(c.name).second) << c.name;
    EXPECT_FALSE(c.difficulty.empty() || c.criterion.empty()) << c.name;
  }
}

TEST(StabilitySuite, ACriterionThatDoesNotHoldIsAFailureAndTheRunGoesOn) {
  const std::vector<StabilityCase> cases = {
      {"beyond", "-", "-", [](Trial& trial) { trial.at_most("gain", 2, 1); }},
      {"nan", "-", "-", [](Trial& trial) { trial.at_least("height", std::nan(""), 1); }},
      {"throws", "-", "-", [](Trial&) { throw std::runtime_error("no file"); }},
      {"idle", "-", "-", [](Trial&) {}},
      {"passes", "-", "-", [](Trial& trial) { trial.at_most("gain", 1, 1); }}};
  const auto reports = run_stability(cases, {});
  ASSERT_TRUE(reports);
  EXPECT_EQ(reports->size(), cases.size());
  for (const StabilityCaseReport& report : *reports) {
    EXPECT_EQ(report.trials.size(), 6u);
    EXPECT_EQ(report.passed(), report.name == "passes") << report.name;
  }
  EXPECT_NE(to_markdown(*reports).find("FAILED beyond, resolution 2, far: gain = 2, at most 1 is asked"),
            std::string::npos);
  const auto json = nlohmann::json::parse(to_json(*reports, false));
  EXPECT_EQ(json["schema"], "selvage.bench.stability/1");
  EXPECT_EQ(json["passed"], 1);
  EXPECT_EQ(json["cases"][2]["trials"][0]["failure"], "no file");
}

TEST(StabilitySuite, ARunThatIsEndedHasNoVerdict) {
  StabilityOptions options;
  options.progress = [](std::size_t done, std::size_t) { return done < 3; };
  EXPECT_FALSE(run_stability(stability_cases(), options));
}

TEST(ExactWatch, SeesWhatAStepMustNotDo) {
  const TwoTriangles scene;
  Trial trial({});
  sim::CollisionOptions options;
  options.tolerance_m = options.thickness_m = 1e-3;
  ExactWatch watch(trial, scene.triangles, {}, 6, options);
  EXPECT_NO_THROW(watch.start(scene.x));
  EXPECT_THROW(watch.start(scene.lowered(1)), CriterionFailed) << "coplanar overlap at the start";
  EXPECT_NO_THROW(watch.step(scene.x, scene.lowered(0.5), scene.report));
  EXPECT_THROW(watch.step(scene.x, scene.lowered(2), scene.report), CriterionFailed) << "passes through";
  EXPECT_THROW(watch.step(scene.x, scene.lowered(1), scene.report), CriterionFailed) << "touches at the end";
  EXPECT_THROW(watch.step(scene.x, scene.lowered(1 - 1e-4), scene.report), CriterionFailed) << "near, and not named";
  EXPECT_THROW(watch.step(scene.x, scene.lowered(1 - 2e-4), scene.report), CriterionFailed)
      << "not named either, where an earlier step ended nearer";
  sim::CollisionStepReport stopped;
  stopped.status = sim::StepStatus::kStopped;
  EXPECT_THROW(watch.step(scene.x, scene.x, stopped), CriterionFailed);
  EXPECT_EQ(trial.report().gap_at_least_m, 1e-3 / 16);
}

}  // namespace selvage::bench
