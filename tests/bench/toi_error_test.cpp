#include "bench/toi_error.h"

#include <gtest/gtest.h>

namespace selvage::bench {
namespace {

TEST(ToiErrors, LateAnswersCountAsNotEarly) {
  ToiErrors errors;
  errors.add(0.5, 0.25, false);
  errors.add(0.5, 0.375, false);
  errors.add(0.5, 0.75, true);
  const ToiError error = errors.summary();
  EXPECT_EQ(errors.count(), 3);
  EXPECT_EQ(error.late, 1);
  EXPECT_EQ(error.late_max, 0.25);
  EXPECT_EQ(error.early_median, 0.125);
  EXPECT_EQ(error.early_max, 0.25);
}

TEST(ToiErrors, OfNoAnswerAreZero) {
  const ToiError error = ToiErrors().summary();
  EXPECT_EQ(error.late, 0);
  EXPECT_EQ(error.early_median, 0);
  EXPECT_EQ(error.early_max, 0);
}

}  // namespace
}  // namespace selvage::bench
