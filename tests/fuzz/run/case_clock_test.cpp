#include "fuzz/run/case_clock.h"

#include <gtest/gtest.h>

namespace selvage::fuzz {
namespace {

using std::chrono::milliseconds;

constexpr double kCase_s = 1;
constexpr milliseconds kLook(100);  ///< as the driver does

/// A worker in one case, looked at until the clock says that it is over, or for `looks` looks: how many it took.
struct Worker {
  WorkerSight sight{.beat = 1, .processor_seconds = 7, .is_asleep = false, .now = {}};
  CaseClock clock;

  int looks_until_over(int looks, double processor_seconds, milliseconds between = kLook) {
    for (int look = 1; look <= looks; ++look) {
      sight.now += between;
      sight.processor_seconds += processor_seconds;
      if (clock.is_over(sight, kCase_s)) return look;
    }
    return 0;
  }
};

TEST(CaseClock, EndsWhatComputesTooLong) {
  Worker worker;
  EXPECT_EQ(worker.looks_until_over(1000, 0.0625), 18);  // the first look begins; 16 are the second itself
  Worker slowly;
  EXPECT_EQ(slowly.looks_until_over(1000, 0.0625, milliseconds(5000)), 18);
}

TEST(CaseClock, EndsWhatSleepsForEver) {
  Worker worker;
  worker.sight.is_asleep = true;
  const int looks = worker.looks_until_over(1000, 0);
  EXPECT_GE(looks, 10);
  EXPECT_LE(looks, 12);
}

TEST(CaseClock, AddsWhatIsComputedToWhatIsSlept) {
  Worker worker;
  EXPECT_EQ(worker.looks_until_over(11, 0.0625), 0);  // the first look begins; then 0.625 of the second
  worker.sight.is_asleep = true;
  const int looks = worker.looks_until_over(1000, 0);
  EXPECT_GE(looks, 4);
  EXPECT_LE(looks, 5);
}

TEST(CaseClock, LetsWaitWhatGetsNoProcessor) {
  Worker worker;
  EXPECT_EQ(worker.looks_until_over(100'000, 0), 0);
}

TEST(CaseClock, DoesNotCountTheTimeInWhichNobodyLooks) {
  // The whole campaign is stopped for an hour, three times, and the worker happens to sleep.
  Worker worker;
  worker.sight.is_asleep = true;
  EXPECT_EQ(worker.looks_until_over(4, 0, std::chrono::hours(1)), 0);
}

TEST(CaseClock, BeginsAnewWithEachCase) {
  Worker worker;
  for (int test_case = 0; test_case < 50; ++test_case) {
    ++worker.sight.beat;
    worker.sight.is_asleep = false;
    EXPECT_EQ(worker.looks_until_over(10, 0.0625), 0);
    worker.sight.is_asleep = true;
    EXPECT_EQ(worker.looks_until_over(3, 0), 0);
  }
}

}  // namespace
}  // namespace selvage::fuzz
