#include "cli/answer/read_back.h"

#include <gtest/gtest.h>

#include "io/error.h"
#include "tests/verify/frames.h"

namespace selvage::cli {

TEST(ReadBack, OnlyWhatWasWrittenIsGivenOut) {
  const io::MeshData first{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}, {}};
  io::MeshData second = first;
  second.points[2][2] = 0x1p-60;
  const std::uint32_t of_first = checksum(first.points), of_second = checksum(second.points);
  const auto read = [&](std::vector<std::uint32_t> checksums) {
    return read_back(std::make_unique<testing::Frames>(std::vector{first, second}), {}, std::move(checksums));
  };
  const auto whole = read({of_first, of_second});
  EXPECT_EQ(whole->frame(0).points, first.points);
  EXPECT_EQ(whole->frame(1).points, second.points);
  const auto spoilt = read({of_first, of_first});
  EXPECT_NO_THROW((void)spoilt->frame(0));
  EXPECT_THROW((void)spoilt->frame(1), io::Error);
  EXPECT_THROW((void)read({of_first}), io::Error) << "a frame too many";
}

}  // namespace selvage::cli
