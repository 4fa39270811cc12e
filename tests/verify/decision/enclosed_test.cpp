#include "verify/decision/enclosed.h"

#include <cmath>
#include <map>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace selvage::verify {
namespace {

constexpr int kSide = 5;  // cells

/// A solid of cells of a lattice; none at its border.
class Cells {
 public:
  explicit Cells(unsigned seed) {
    std::mt19937 random(seed);
    for (int i = 1; i + 1 < kSide; ++i) {
      for (int j = 1; j + 1 < kSide; ++j) {
        for (int k = 1; k + 1 < kSide; ++k) is_full_[cell(i, j, k)] = random() % 2 == 0;
      }
    }
  }
  [[nodiscard]] bool at(int i, int j, int k) const {
    const auto found = is_full_.find(cell(i, j, k));
    return found != is_full_.end() && found->second;
  }

 private:
  static std::array<int, 3> cell(int i, int j, int k) { return {i, j, k}; }
  std::map<std::array<int, 3>, bool> is_full_;
};

struct CellFaces {
  std::vector<Point> V;
  std::vector<std::array<std::int32_t, 3>> F;
};

/// Its faces, two a square, anyhow turned; each with corners of its own: only where they are matters.
CellFaces faces_of_cells(const Cells& cells) {
  CellFaces surface;
  const auto add = [&](Point origin, std::size_t axis) {
    const auto n = static_cast<std::int32_t>(surface.V.size());
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const auto& [a, b] : {std::array{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      Point corner = origin;
      corner[u] += a;
      corner[v] += b;
      surface.V.push_back(corner);
    }
    surface.F.push_back({n, n + 1, n + 2});
    surface.F.push_back({n, n + 3, n + 2});
  };
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      for (int k = 0; k < kSide; ++k) {
        const Point origin{double(i), double(j), double(k)};
        if (cells.at(i, j, k) != cells.at(i - 1, j, k)) add(origin, 0);
        if (cells.at(i, j, k) != cells.at(i, j - 1, k)) add(origin, 1);
        if (cells.at(i, j, k) != cells.at(i, j, k - 1)) add(origin, 2);
      }
    }
  }
  return surface;
}

}  // namespace

TEST(Enclosed, PointsAreOnTheirSideWhateverTheirRayRunsThrough) {
  int inside = 0, through_edges = 0;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Cells cells(seed);
    const CellFaces surface = faces_of_cells(cells);
    // In cells, and on lattice lines, planes and vertices about which all cells are alike; a half a lattice unit apart.
    for (int x = 1; x < 2 * kSide; ++x) {
      for (int y = 1; y < 2 * kSide; ++y) {
        for (int z = 1; z < 2 * kSide; ++z) {
          const bool is_full = cells.at(x / 2, y / 2, z / 2);
          bool is_on_surface = false;
          for (int near = 0; near < 8; ++near) {
            is_on_surface = is_on_surface || cells.at((x - (near & 1)) / 2, (y - (near >> 1 & 1)) / 2,
                                                      (z - (near >> 2 & 1)) / 2) != is_full;
          }
          if (is_on_surface) continue;
          EXPECT_EQ(is_enclosed({x / 2.0, y / 2.0, z / 2.0}, surface.F, surface.V), is_full)
              << "seed " << seed << ": " << x << " " << y << " " << z;
          inside += is_full ? 1 : 0;
          through_edges += x % 2 == 0 || y % 2 == 0 ? 1 : 0;
        }
      }
    }
  }
  EXPECT_GT(inside, 200);
  EXPECT_GT(through_edges, 1000);
}

TEST(Enclosed, OneRoundingFromAFaceIsDecidedExactly) {
  const std::vector<Point> V = {{0, 0, 0}, {3, 1, 1}, {1, 3, 1}, {1.25, 1.25, -4}};
  const std::vector<std::array<std::int32_t, 3>> F = {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}};
  const double z = (0.75 + 0.875) / 4;  // on the first face, exactly
  for (const double shift : {0x1p-54, 0x1p-53, 0x1p-40}) {
    EXPECT_TRUE(is_enclosed({0.75, 0.875, z - shift}, F, V)) << shift;
    EXPECT_FALSE(is_enclosed({0.75, 0.875, z + shift}, F, V)) << shift;
  }
  EXPECT_FALSE(is_enclosed({0.75, 0.875, -9}, F, V));
}

}  // namespace selvage::verify
