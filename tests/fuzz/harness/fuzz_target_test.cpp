#include "fuzz/harness/fuzz_target.h"

#include <gtest/gtest.h>

#include "fuzz/kept/case_file.h"

namespace selvage::fuzz {

/// What fuzz_replay prints for an input that fails is for `selvage replay`.
TEST(FuzzTarget, TheCaseOfAnInputCanBeReadBack) {
  const auto target = fuzz_target("query");
  target->prepare();
  for (const std::string& seed : target->seeds()) {
    const std::string text =
        target->kept({reinterpret_cast<const std::uint8_t*>(seed.data()), seed.size()}, "ccd missed");
    ASSERT_FALSE(text.empty());
    EXPECT_NO_THROW(static_cast<void>(parse_case(text, "kept"))) << text;
  }
}

}  // namespace selvage::fuzz
