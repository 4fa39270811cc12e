// The curve that elements are ordered along, and the order.
#include "verify/search/curve_order.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <random>

#include <gtest/gtest.h>

namespace selvage::verify {
namespace {

using LatticePoint = std::array<std::int32_t, 3>;

/// The points of an 8 x 8 x 8 grid with 2^`shift` between them.
std::vector<LatticePoint> grid(int shift) {
  std::vector<LatticePoint> points;
  for (std::int32_t i = 0; i < 512; ++i) {
    points.push_back({(i % 8 - 4) * (1 << shift), (i / 8 % 8 - 4) * (1 << shift), (i / 64 - 4) * (1 << shift)});
  }
  return points;
}

std::vector<std::int32_t> order_of(const std::vector<std::uint64_t>& codes) {
  return order_by_code(codes.size(), [&](std::size_t i) { return codes[i]; });
}

}  // namespace

TEST(HilbertCode, GoesFromCellToNeighbouringCell) {
  for (const int shift : {16, 20, 27}) {
    std::vector<LatticePoint> points = grid(shift);
    std::sort(points.begin(), points.end(),
              [](const auto& a, const auto& b) { return hilbert_code(a) < hilbert_code(b); });
    int jumps = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      std::int64_t distance = 0;
      for (std::size_t k = 0; k < 3; ++k) distance += std::abs(std::int64_t{points[i][k]} - points[i - 1][k]);
      jumps += distance == std::int64_t{1} << shift ? 0 : 1;
    }
    // Around zero eight cubes of the curve meet: it leaves this grid and comes back where it goes from one to the next.
    EXPECT_LE(jumps, 7) << shift;
  }
}

TEST(HilbertCode, TellsPointsApart) {
  std::vector<std::uint64_t> codes;
  for (const LatticePoint& point : grid(16)) codes.push_back(hilbert_code(point));
  std::sort(codes.begin(), codes.end());
  EXPECT_EQ(std::adjacent_find(codes.begin(), codes.end()), codes.end());
  EXPECT_LT(codes.back(), std::uint64_t{1} << 48);
}

TEST(OrderByCode, IsThatOfTheCodes) {
  std::mt19937_64 random(3);
  for (const std::uint64_t bound : {std::uint64_t{1} << 48, std::uint64_t{1} << 20, std::uint64_t{50}}) {
    std::vector<std::uint64_t> codes(3000);  // spread out; all with the same upper bits; many equal ones
    for (std::uint64_t& code : codes) code = random() % bound;
    const std::vector<std::int32_t> order = order_of(codes);
    std::vector<std::int32_t> expected(codes.size());
    std::iota(expected.begin(), expected.end(), 0);
    std::stable_sort(expected.begin(), expected.end(), [&](std::int32_t i, std::int32_t j) {
      return codes[static_cast<std::size_t>(i)] < codes[static_cast<std::size_t>(j)];
    });
    EXPECT_EQ(order, expected) << bound;
  }
  EXPECT_TRUE(order_of({}).empty());
  EXPECT_EQ(order_of({5}), std::vector<std::int32_t>{0});
}

}  // namespace selvage::verify
