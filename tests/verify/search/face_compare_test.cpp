// The lanes: every set of instructions gives the same answers, in one go or in several.
#include "verify/search/face_compare.h"

#include <random>

#include <gtest/gtest.h>

namespace selvage::verify {
namespace {

struct Blocks {
  std::vector<FaceBlock> faces;
  std::vector<FaceBounds> bounds;
};

/// Small faces at random, neighbours by index too; the last block is not full.
Blocks random_blocks(std::size_t count) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> anywhere(-1, 1), near(-0.3, 0.3);
  const FloatFrame frame = FloatFrame::over({{-2, -2, -2}, {2, 2, 2}});
  Blocks blocks{std::vector<FaceBlock>(count), std::vector<FaceBounds>(count)};
  for (std::size_t b = 0; b < count; ++b) {
    const std::size_t size = b + 1 < count ? FaceBlock::kWidth : 3;
    for (std::size_t i = 0; i < size; ++i) {
      std::vector<Point> V(24);
      const Point middle = {anywhere(random), anywhere(random), anywhere(random)};
      std::array<std::int32_t, 3> triangle{};
      for (std::size_t j = 0; j < 3; ++j) {
        triangle[j] = static_cast<std::int32_t>(8 * j + random() % 8);
        for (std::size_t k = 0; k < 3; ++k) V[static_cast<std::size_t>(triangle[j])][k] = middle[k] + near(random);
      }
      const FloatFace face(triangle, V, frame);
      blocks.faces[b].set(i, face);
      for (std::size_t k = 0; k < 3; ++k) {
        blocks.bounds[b].min[k] = std::min(blocks.bounds[b].min[k], face.min[k]);
        blocks.bounds[b].max[k] = std::max(blocks.bounds[b].max[k], face.max[k]);
      }
    }
  }
  return blocks;
}

/// All matches of the first eight blocks, with `step` blocks at once: block, place, the three masks.
std::vector<std::array<unsigned, 5>> matches(const FaceComparer& comparer, const Blocks& blocks, std::int64_t first,
                                             bool each, std::size_t step, std::int64_t& apart_count) {
  const FaceQuery query(std::span(blocks.faces).first(8), std::span(blocks.bounds).first(8));
  std::vector<std::array<unsigned, 5>> all;
  FaceMatches found;
  for (std::size_t begin = 0; begin < blocks.faces.size(); begin += step) {
    std::vector<std::uint32_t> chosen;
    for (std::size_t b = begin; b < std::min(begin + step, blocks.faces.size()); ++b) {
      chosen.push_back(static_cast<std::uint32_t>(b));
    }
    comparer.compare(query, first, blocks.faces, blocks.bounds, chosen, each, found);
    apart_count += found.apart_count;
    for (const FaceMatch& m : std::span(found.matches).first(found.count)) {
      all.push_back({m.block, m.place, m.meet, m.overlap, m.apart});
    }
  }
  return all;
}

}  // namespace

TEST(FaceCompare, IsTheSameForEverySetOfInstructionsAndNumberOfBlocks) {
  const Blocks blocks = random_blocks(80);
  for (const std::int64_t first : {std::int64_t{0}, kOtherTree}) {
    for (const bool each : {false, true}) {
      std::int64_t expected_count = 0;
      const auto expected = matches(face_comparers().front(), blocks, first, each, 1, expected_count);
      EXPECT_GT(expected.size(), 200U);
      EXPECT_GT(expected_count, 200);
      for (const FaceComparer& comparer : face_comparers()) {
        for (const std::size_t step : {std::size_t{5}, FaceMatches::kMaxBlocks}) {
          std::int64_t count = 0;
          auto found = matches(comparer, blocks, first, each, step, count);
          EXPECT_EQ(count, expected_count) << comparer.instructions;
          EXPECT_EQ(found, expected) << comparer.instructions;
        }
      }
    }
  }
}

}  // namespace selvage::verify
