#include "verify/search/box_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>

#include <gtest/gtest.h>

namespace selvage::verify {
namespace {

using Pairs = std::vector<std::pair<std::int32_t, std::int32_t>>;

Lattice lattice_over(const std::vector<Box>& a, const std::vector<Box>& b) {
  std::vector<Point> corners;
  for (const auto* boxes : {&a, &b}) {
    for (const Box& box : *boxes) corners.insert(corners.end(), {box.min, box.max});
  }
  return Lattice::over(bounding_box(corners));
}

Pairs within(const std::vector<Box>& boxes) {
  if (boxes.empty()) return {};
  const BoxTree tree(boxes, lattice_over(boxes, {}));
  Pairs pairs;
  for (std::size_t block = 0; block < tree.block_count(); ++block) {
    tree.visit_pairs_within(block, [&](std::int32_t i, std::int32_t j) { pairs.emplace_back(std::minmax(i, j)); });
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

Pairs between(const std::vector<Box>& a, const std::vector<Box>& b) {
  const Lattice lattice = lattice_over(a, b);
  const BoxTree tree_a(a, lattice), tree_b(b, lattice);
  Pairs pairs;
  for (std::size_t block = 0; block < tree_a.block_count(); ++block) {
    tree_a.visit_pairs_between(block, tree_b, [&](std::int32_t i, std::int32_t j) { pairs.emplace_back(i, j); });
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

bool overlap(const Box& a, const Box& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (a.max[k] < b.min[k] || b.max[k] < a.min[k]) return false;
  }
  return true;
}

Pairs brute_force(const std::vector<Box>& a, const std::vector<Box>& b, bool same) {
  Pairs pairs;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = same ? i + 1 : 0; j < b.size(); ++j) {
      if (overlap(a[i], b[j])) pairs.emplace_back(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j));
    }
  }
  return pairs;
}

enum class Scene { kCloud, kTouchingGrid, kPoints, kFlat, kOneFarAway, kHuge, kSubnormal, kAllAlike };

std::vector<Box> draw(std::mt19937& random, Scene scene, std::size_t count) {
  std::uniform_real_distribution<double> place(0, 1), extent(0, 0.1);
  std::uniform_int_distribution<int> cell(0, 9);
  std::vector<Box> boxes(count);
  for (Box& box : boxes) {
    for (std::size_t k = 0; k < 3; ++k) {
      double low = place(random), high = low + extent(random);
      if (scene == Scene::kTouchingGrid) low = cell(random), high = low + 1;
      if (scene == Scene::kPoints) low = high = cell(random);
      if (scene == Scene::kFlat && k == 2) low = high = 0;
      if (scene == Scene::kHuge) low = (low - 0.5) * 0x1p1023, high = std::max(low, (high - 0.5) * 0x1p1023);
      if (scene == Scene::kSubnormal) low *= 0x1p-1070, high *= 0x1p-1070;
      if (scene == Scene::kAllAlike) low = high = 0.1;
      box.min[k] = low;
      box.max[k] = high;
    }
  }
  if (scene == Scene::kOneFarAway && !boxes.empty()) boxes.front() = {{1e300, -1e300, 0}, {1e300, 1e300, 0}};
  return boxes;
}

constexpr Scene kScenes[] = {Scene::kCloud,      Scene::kTouchingGrid, Scene::kPoints,    Scene::kFlat,
                             Scene::kOneFarAway, Scene::kHuge,         Scene::kSubnormal, Scene::kAllAlike};

}  // namespace

TEST(BoxPairs, WithinIsBruteForce) {
  std::mt19937 random(1);
  for (const Scene scene : kScenes) {
    for (const std::size_t count : std::initializer_list<std::size_t>{0, 1, 2, 7, 8, 9, 64, 65, 300, 700}) {
      const std::vector<Box> boxes = draw(random, scene, count);
      EXPECT_EQ(within(boxes), brute_force(boxes, boxes, true)) << static_cast<int>(scene) << ", " << count;
    }
  }
}

TEST(BoxPairs, BetweenIsBruteForce) {
  std::mt19937 random(2);
  for (const Scene scene : kScenes) {
    for (const auto& [count_a, count_b] :
         {std::pair<std::size_t, std::size_t>{1, 0}, {0, 5}, {1, 1}, {3, 700}, {500, 90}}) {
      const std::vector<Box> a = draw(random, scene, count_a), b = draw(random, scene, count_b);
      EXPECT_EQ(between(a, b), brute_force(a, b, false)) << static_cast<int>(scene) << ", " << count_a;
    }
  }
}

TEST(BoxPairs, GrownBoxesReachAtLeastTheDistance) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> draw_coordinate(-1000, 1000);
  for (int i = 0; i < 1000; ++i) {
    const double x = draw_coordinate(random), distance = std::abs(draw_coordinate(random)) * 0x1p-40;
    const Box box = grown({{x, x, x}, {x, x, x}}, distance);
    // Rounded subtraction of the outward bounds cannot fall short of the distance by more than its own rounding.
    EXPECT_LT(box.min[0], x);
    EXPECT_GE(x - box.min[0], distance * (1 - 0x1p-53));
    EXPECT_GE(box.max[0] - x, distance * (1 - 0x1p-53));
  }
  const Box everything = grown({{-1e308, 0, 0}, {1e308, 0, 0}}, 1.7e308);
  EXPECT_EQ(everything.min[0], std::numeric_limits<double>::lowest());
  EXPECT_EQ(everything.max[0], std::numeric_limits<double>::max());
}

TEST(BoxPairs, LatticeNeverDecreases) {
  std::mt19937_64 random(4);
  const Box bounds{{-1e308, -3, 0x1p-1074}, {1.7e308, 5, 0x1p-1060}};
  const Lattice lattice = Lattice::over(bounds);
  std::vector<double> values = {-1e308, -1, -0x1p-1074, 0, 0x1p-1074, 1, 1.7e308};
  for (int i = 0; i < 3000; ++i) {
    const double x = std::bit_cast<double>(random());
    if (std::isfinite(x)) values.push_back(x);
  }
  std::sort(values.begin(), values.end());
  for (std::size_t i = 0; i + 1 < values.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_LE(lattice(k, values[i]), lattice(k, values[i + 1]));
  }
}

}  // namespace selvage::verify
