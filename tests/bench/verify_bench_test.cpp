// Forks its measurements: this program must not start threads of its own, so it stands alone.
#include "bench/verify_bench.h"

#include <future>
#include <stdexcept>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "bench/child_process.h"

#if defined(__SANITIZE_THREAD__)
#define SELVAGE_NEEDS_ONE_THREAD() GTEST_SKIP() << "ThreadSanitizer keeps a thread of its own: nothing can be forked"
#else
#define SELVAGE_NEEDS_ONE_THREAD() static_cast<void>(0)
#endif

namespace selvage::bench {
namespace {

VerifyBenchOptions quick() {
  return {.faces = {600}, .layers = 3, .thread_counts = {1, 2}, .repeat = 1, .motion = true};
}

/// Finds what CGAL finds but the first pair, and the pair (0, 1), which is none.
class BadRival : public FrameRival {
 public:
  explicit BadRival(std::unique_ptr<FrameRival> good) : good_(std::move(good)) {}
  void build(std::span<const std::array<std::int32_t, 3>> triangles,
             std::span<const std::array<double, 3>> points) override {
    good_->build(triangles, points);
  }
  std::vector<std::array<std::int32_t, 2>> intersections(bool in_parallel) override {
    auto pairs = good_->intersections(in_parallel);
    if (!pairs.empty()) pairs.front() = {0, 1};
    return pairs;
  }

 private:
  std::unique_ptr<FrameRival> good_;
};

}  // namespace

TEST(VerifyBench, TheCheckerAndCgalFindTheSamePairs) {
  SELVAGE_NEEDS_ONE_THREAD();
  const auto reports = run_verify_bench(load_frame_rival(SELVAGE_RIVALS), quick());
  ASSERT_EQ(reports.size(), 2U);
  for (const VerifySheetReport& report : reports) {
    EXPECT_FALSE(is_wrong(report));
    ASSERT_EQ(report.methods.size(), 6U);
    EXPECT_NEAR(static_cast<double>(report.faces), 600, 100);
    for (const VerifyMethodReport& method : report.methods) {
      EXPECT_EQ(method.found > 0, report.planted) << method.name;
      EXPECT_GT(method.check.cpu, 0) << method.name;
      EXPECT_EQ(method.examined > 0, method.name != "cgal") << method.name;
    }
  }
}

TEST(VerifyBench, ARivalIsChargedWithWhatItMissesAndAdds) {
  SELVAGE_NEEDS_ONE_THREAD();
  const LoadedFrameRival good = load_frame_rival(SELVAGE_RIVALS);
  const LoadedFrameRival bad{{}, [&] { return std::make_unique<BadRival>(good.create()); }};
  const auto reports = run_verify_bench(bad, quick());
  EXPECT_FALSE(is_wrong(reports[0]));
  EXPECT_TRUE(is_wrong(reports[1]));
  EXPECT_EQ(reports[1].methods.back().missing, 1);
  EXPECT_EQ(reports[1].methods.back().extra, 1);
}

TEST(VerifyBench, WhatIsFoundOnACleanSheetOrNotOnAPlantedOneIsWrong) {
  VerifySheetReport report;
  report.methods.resize(1);
  report.methods[0].found = 1;
  EXPECT_TRUE(is_wrong(report));
  report.planted = true;
  EXPECT_FALSE(is_wrong(report));
  report.methods[0].extra = 1;
  EXPECT_TRUE(is_wrong(report)) << "pairs that the others do not find";
  report.methods[0].extra = 0;
  report.methods[0].missing = 1;
  EXPECT_TRUE(is_wrong(report)) << "pairs that the others find";
  report.methods[0].missing = 0;
  report.methods[0].found = 0;
  EXPECT_TRUE(is_wrong(report));
}

TEST(VerifyBench, JsonCarriesItsSchemaAndSaysWhoIsAbsent) {
  VerifySheetReport report;
  report.faces = 7;
  report.methods.resize(1);
  report.methods[0].found = 3;
  const LoadedFrameRival absent = load_frame_rival("no/such/folder");
  EXPECT_FALSE(absent.create);
  const auto json = nlohmann::json::parse(to_json({report}, absent));
  EXPECT_EQ(json["schema"], "selvage.bench.verify/1");
  EXPECT_EQ(json["sheets"][0]["faces"], 7);
  EXPECT_EQ(json["sheets"][0]["methods"][0]["found"], 3);
  EXPECT_NE(json["absent"]["cgal"].get<std::string>().find("cgal_faces"), std::string::npos);
}

TEST(ChildProcess, GivesItsAnswerAndItsOwnPeakOfMemory) {
  SELVAGE_NEEDS_ONE_THREAD();
  const auto touch = [](std::size_t size) {
    return run_in_child([size] { return std::to_string(std::string(size, 'x').size()); });
  };
  const ChildOutcome small = touch(1), large = touch(std::size_t{64} << 20);
  EXPECT_EQ(large.answer, std::to_string(64 << 20));
  EXPECT_NEAR(static_cast<double>(large.peak_bytes - small.peak_bytes), 64 << 20, 8 << 20);
}

TEST(ChildProcess, PassesExceptionsOnAndNoticesADeath) {
  SELVAGE_NEEDS_ONE_THREAD();
  const auto message_of = [](const std::function<std::string()>& body) -> std::string {
    try {
      return run_in_child(body).answer;
    } catch (const std::runtime_error& error) {
      return error.what();
    }
  };
  EXPECT_EQ(message_of([]() -> std::string { throw std::invalid_argument("no manifold"); }), "no manifold");
  EXPECT_EQ(message_of([]() -> std::string { ::_exit(0); }), "a child of the benchmark died");
}

TEST(ChildProcess, RefusesToForkAmongThreads) {
  std::promise<void> done;
  std::thread other([&] { done.get_future().wait(); });
  EXPECT_THROW(static_cast<void>(run_in_child([] { return std::string(); })), std::logic_error);
  done.set_value();
  other.join();
}

}  // namespace selvage::bench
