#include "kernel/mesh.h"

#include <gtest/gtest.h>

namespace selvage {

TEST(InputErrorText, EveryErrorSaysWhatToDo) {
  for (int i = 0; i <= static_cast<int>(InputError::kBadTolerance); ++i) {
    EXPECT_STRNE(describe(static_cast<InputError>(i)), "unknown error");
  }
}

}  // namespace selvage
