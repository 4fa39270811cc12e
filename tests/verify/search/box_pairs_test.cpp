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

template <std::size_t kInstants>
using Set = std::vector<Boxes<kInstants>>;

template <std::size_t kInstants>
Lattices<kInstants> lattices_over(const Set<kInstants>& a, const Set<kInstants>& b) {
  Lattices<kInstants> lattices;
  for (std::size_t i = 0; i < kInstants; ++i) {
    std::vector<Point> corners;
    for (const auto* set : {&a, &b}) {
      for (const Boxes<kInstants>& boxes : *set) corners.insert(corners.end(), {boxes[i].min, boxes[i].max});
    }
    lattices[i] = Lattice::over(bounding_box(corners));
  }
  return lattices;
}

template <std::size_t kInstants>
using LatticeSet = std::vector<LatticeBoxes<kInstants>>;

template <std::size_t kInstants>
LatticeSet<kInstants> on_lattices_of(const Lattices<kInstants>& lattices, const Set<kInstants>& set) {
  LatticeSet<kInstants> result;
  for (const Boxes<kInstants>& each : set) result.push_back(on_lattices(lattices, each));
  return result;
}

template <std::size_t kInstants>
Pairs within(const LatticeSet<kInstants>& boxes) {
  const BoxTree<kInstants> tree(boxes);
  Pairs pairs;
  for (std::size_t block = 0; block < tree.block_count(); ++block) {
    tree.visit_pairs_within(block, [&](std::int32_t i, std::int32_t j) { pairs.emplace_back(std::minmax(i, j)); });
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

template <std::size_t kInstants>
Pairs between(const LatticeSet<kInstants>& a, const LatticeSet<kInstants>& b) {
  const BoxTree<kInstants> tree_a(a), tree_b(b);
  Pairs pairs;
  for (std::size_t block = 0; block < tree_a.block_count(); ++block) {
    tree_a.visit_pairs_between(block, tree_b, [&](std::int32_t i, std::int32_t j) { pairs.emplace_back(i, j); });
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

/// No plane across an axis is between the two at every instant.
template <class Two>
bool may_meet(const Two& a, const Two& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    std::size_t below = 0, above = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      if (a[i].max[k] < b[i].min[k]) ++below;
      if (b[i].max[k] < a[i].min[k]) ++above;
    }
    if (below == a.size() || above == a.size()) return false;
  }
  return true;
}

template <class Many>
Pairs brute_force(const Many& a, const Many& b, bool same) {
  Pairs pairs;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = same ? i + 1 : 0; j < b.size(); ++j) {
      if (may_meet(a[i], b[j])) pairs.emplace_back(static_cast<std::int32_t>(i), static_cast<std::int32_t>(j));
    }
  }
  return pairs;
}

enum class Scene { kCloud, kTouchingGrid, kPoints, kFlat, kOneFarAway, kEnormous, kSubnormal, kAllAlike };

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
      if (scene == Scene::kEnormous) low = (low - 0.5) * 0x1p1023, high = std::max(low, (high - 0.5) * 0x1p1023);
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
                             Scene::kOneFarAway, Scene::kEnormous,     Scene::kSubnormal, Scene::kAllAlike};

/// At each instant others of the scene, so that boxes go anywhere.
template <std::size_t kInstants>
Set<kInstants> draw_set(std::mt19937& random, Scene scene, std::size_t count) {
  Set<kInstants> set(count);
  for (std::size_t i = 0; i < kInstants; ++i) {
    const std::vector<Box> boxes = draw(random, scene, count);
    for (std::size_t n = 0; n < count; ++n) set[n][i] = boxes[n];
  }
  return set;
}

template <std::size_t kInstants>
void within_is_brute_force() {
  EXPECT_TRUE(within(LatticeSet<kInstants>()).empty());
  std::mt19937 random(1);
  for (const Scene scene : kScenes) {
    for (const std::size_t count : std::initializer_list<std::size_t>{1, 2, 7, 8, 9, 64, 65, 300, 700}) {
      const auto set = draw_set<kInstants>(random, scene, count);
      const auto boxes = on_lattices_of(lattices_over(set, {}), set);
      const Pairs found = within(boxes), meeting = brute_force(set, set, true);
      EXPECT_EQ(found, brute_force(boxes, boxes, true)) << static_cast<int>(scene) << ", " << count;
      EXPECT_TRUE(std::ranges::includes(found, meeting)) << static_cast<int>(scene) << ", " << count;
    }
  }
}

template <std::size_t kInstants>
void between_is_brute_force() {
  std::mt19937 random(2);
  for (const Scene scene : kScenes) {
    for (const auto& [count_a, count_b] :
         {std::pair<std::size_t, std::size_t>{1, 0}, {0, 5}, {1, 1}, {3, 700}, {500, 90}}) {
      const auto set_a = draw_set<kInstants>(random, scene, count_a),
                 set_b = draw_set<kInstants>(random, scene, count_b);
      const auto lattices = lattices_over(set_a, set_b);
      const auto a = on_lattices_of(lattices, set_a), b = on_lattices_of(lattices, set_b);
      const Pairs found = between(a, b), meeting = brute_force(set_a, set_b, false);
      EXPECT_EQ(found, brute_force(a, b, false)) << static_cast<int>(scene) << ", " << count_a;
      EXPECT_TRUE(std::ranges::includes(found, meeting)) << static_cast<int>(scene) << ", " << count_a;
    }
  }
}

}  // namespace

TEST(BoxPairs, WithinIsBruteForce) {
  within_is_brute_force<1>();
  within_is_brute_force<2>();
}

TEST(BoxPairs, BetweenIsBruteForce) {
  between_is_brute_force<1>();
  between_is_brute_force<2>();
}

// Coordinates are multiples of 16, so that those at every sixteenth of the way are exact.
TEST(BoxPairs, WhatMeetsOnTheWayIsFound) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> coordinate(-20, 20), extent(0, 4);
  Set<2> boxes(200);
  for (Boxes<2>& each : boxes) {
    for (Box& box : each) {
      for (std::size_t k = 0; k < 3; ++k) {
        box.min[k] = 16 * coordinate(random);
        box.max[k] = box.min[k] + 16 * extent(random);
      }
    }
  }
  const auto bound_at = [](double t0, double t1, int sixteenth) { return t0 + (t1 - t0) / 16 * sixteenth; };
  const auto meet_at = [&](const Boxes<2>& a, const Boxes<2>& b, int sixteenth) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto min = [&](const Boxes<2>& of) { return bound_at(of[0].min[k], of[1].min[k], sixteenth); };
      const auto max = [&](const Boxes<2>& of) { return bound_at(of[0].max[k], of[1].max[k], sixteenth); };
      if (max(a) < min(b) || max(b) < min(a)) return false;
    }
    return true;
  };
  const Pairs found = within(on_lattices_of(lattices_over(boxes, {}), boxes));
  std::size_t only_on_the_way = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = i + 1; j < boxes.size(); ++j) {
      bool meets = false;
      for (int sixteenth = 0; sixteenth <= 16; ++sixteenth) meets |= meet_at(boxes[i], boxes[j], sixteenth);
      if (!meets) continue;
      const std::pair pair{static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)};
      EXPECT_TRUE(std::ranges::binary_search(found, pair)) << i << ", " << j;
      if (!meet_at(boxes[i], boxes[j], 0) && !meet_at(boxes[i], boxes[j], 16)) ++only_on_the_way;
    }
  }
  EXPECT_GT(only_on_the_way, 100U);
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
