// Every pair of triangles with corners on a small lattice, up to the symmetries of the lattice, in every incidence: the
// decision, and the frame check around it, against clipping in rational arithmetic.
#include <cstdio>
#include <cstdlib>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "tests/verify/overlap_reference.h"
#include "verify/check.h"

namespace selvage::verify {
namespace {

using Face = std::array<std::int32_t, 3>;
using Corners = std::array<Point, 3>;
using Size = std::array<int, 3>;

std::vector<Point> lattice(const Size& size) {
  std::vector<Point> points;
  for (int x = 0; x < size[0]; ++x) {
    for (int y = 0; y < size[1]; ++y) {
      for (int z = 0; z < size[2]; ++z) points.push_back({x * 1.0, y * 1.0, z * 1.0});
    }
  }
  return points;
}

/// The first `shared` corners in ascending order, and the others. Both are sets: order does not tell triangles apart.
Corners sorted(Corners triangle, std::size_t shared) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i + 1; j < 3; ++j) {
      if ((i < shared) == (j < shared) && triangle[j] < triangle[i]) std::swap(triangle[i], triangle[j]);
    }
  }
  return triangle;
}

/// Whether no symmetry of the lattice (reflections, exchanges of equal sides) makes it smaller: one of each orbit.
bool is_representative(const Corners& triangle, std::size_t shared, const Size& size) {
  std::array<std::size_t, 3> axes = {0, 1, 2};
  do {
    if (size[axes[0]] != size[0] || size[axes[1]] != size[1]) continue;
    for (unsigned reflections = 0; reflections < 8; ++reflections) {
      Corners image = triangle;
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          const double x = triangle[i][axes[k]];
          image[i][k] = (reflections >> k & 1U) != 0 ? size[k] - 1 - x : x;
        }
      }
      if (sorted(image, shared) < triangle) return false;
    }
  } while (std::next_permutation(axes.begin(), axes.end()));
  return true;
}

/// All triangles of lattice points that begin with the given corners; zero area and coinciding corners included.
std::vector<Corners> triangles(const std::vector<Point>& points, const Corners& given, std::size_t given_count,
                               std::size_t shared) {
  std::vector<Corners> found = {given};
  for (std::size_t i = given_count; i < 3; ++i) {
    std::vector<Corners> longer;
    for (Corners triangle : found) {
      for (const Point& p : points) {
        triangle[i] = p;
        if (i == 0 || i == shared || !(p < triangle[i - 1])) longer.push_back(triangle);
      }
    }
    found = std::move(longer);
  }
  return found;
}

struct Enumeration {
  /// [corners that are the same vertex][dimension of what they have in common, plus one][kind]
  std::array<std::array<std::array<long, 6>, 4>, 4> pairs{};
  std::array<long, 3> by_degenerate{};  ///< pairs with so many faces without area
  long duplicates = 0;                  ///< pairs in which two vertices have one position
};

/// What the check of a frame of these two faces must find, by kind.
std::set<std::string> expected_violations(OverlapKind kind, const std::array<bool, 2>& is_degenerate) {
  std::set<std::string> expected;
  if (kind != OverlapKind::kNone) expected.insert(name_of(kind));
  if (is_degenerate[0]) expected.insert("degenerate 0");
  if (is_degenerate[1]) expected.insert("degenerate 1");
  return expected;
}

void examine(std::size_t shared, const Corners& a, const Corners& b, Enumeration& all) {
  std::array<Face, 2> faces = {{{0, 1, 2}, {3, 4, 5}}};
  std::vector<Point> V(a.begin(), a.end());
  V.insert(V.end(), b.begin(), b.end());
  for (std::size_t i = 0; i < shared; ++i) faces[1][i] = faces[0][i];
  const OverlapKind kind = reference::overlap(faces[0], a, faces[1], b);
  ASSERT_EQ(exact_overlap(faces[0], a, faces[1], b).kind, kind);
  // The lattice's symmetries have ordered the corners: the decision sees another order too, and the faces exchanged.
  const auto turned = [](const auto& corners) { return std::array{corners[1], corners[0], corners[2]}; };
  ASSERT_EQ(exact_overlap(turned(faces[1]), turned(b), turned(faces[0]), turned(a)).kind, kind);

  const auto p = reference::exact(a), q = reference::exact(b);
  const std::array<bool, 2> is_degenerate = {reference::hull(p).dimension < 2, reference::hull(q).dimension < 2};
  std::set<std::string> found;
  for (const Violation& v : check_frame(Surface{faces}, V, {}).violations) {
    found.insert(v.event == EventKind::kSelf ? v.kind + " " + std::to_string(v.features[1]) : v.kind);
  }
  ASSERT_EQ(found, expected_violations(kind, is_degenerate));

  const auto dimension = static_cast<std::size_t>(reference::dimension(reference::common_part(p, q)) + 1);
  ++all.pairs[shared][dimension][static_cast<std::size_t>(kind)];
  ++all.by_degenerate[static_cast<std::size_t>(is_degenerate[0]) + static_cast<std::size_t>(is_degenerate[1])];
  if (std::set<Point>(V.begin(), V.end()).size() + shared < 6) ++all.duplicates;
}

void enumerate(const Size& size, Enumeration& all) {
  const std::vector<Point> points = lattice(size);
  for (std::size_t shared = 0; shared <= 3; ++shared) {
    for (const Corners& a : triangles(points, {}, 0, shared)) {
      if (!is_representative(a, shared, size)) continue;
      for (const Corners& b : triangles(points, a, shared, shared)) {
        ASSERT_NO_FATAL_FAILURE(examine(shared, a, b, all))
            << ::testing::PrintToString(a) << ::testing::PrintToString(b);
      }
    }
  }
}

void print(const Enumeration& all) {
  const char* incidences[] = {"none", "vertex", "edge", "face"};
  const char* dimensions[] = {"empty", "point", "segment", "area"};
  for (std::size_t shared = 0; shared < 4; ++shared) {
    for (std::size_t dimension = 0; dimension < 4; ++dimension) {
      std::printf("%s | %s", incidences[shared], dimensions[dimension]);
      for (const long count : all.pairs[shared][dimension]) std::printf(" | %ld", count);
      std::printf("\n");
    }
  }
  std::printf("without area: %ld none, %ld one, %ld both; duplicate positions: %ld\n", all.by_degenerate[0],
              all.by_degenerate[1], all.by_degenerate[2], all.duplicates);
}

}  // namespace

// By hand: SELVAGE_OVERLAP_LATTICE=3 takes all pairs on 3 x 3 x 3 points, and prints how many of what there are.
TEST(OverlapEnumeration, EveryPairOnASmallLattice) {
  Enumeration all;
  if (const char* side = std::getenv("SELVAGE_OVERLAP_LATTICE"); side != nullptr) {
    const int n = std::atoi(side);
    ASSERT_NO_FATAL_FAILURE(enumerate({n, n, n}, all));
    print(all);
    return;
  }
  ASSERT_NO_FATAL_FAILURE(enumerate({3, 3, 1}, all));
  ASSERT_NO_FATAL_FAILURE(enumerate({2, 2, 2}, all));
  ASSERT_NO_FATAL_FAILURE(enumerate({3, 2, 2}, all));
  // The lattices are alive: whatever two triangles can have in common occurs, in every incidence.
  enum Dimension : std::size_t { kEmpty, kPoint, kSegment, kArea };
  using enum OverlapKind;
  const struct {
    std::size_t shared;
    Dimension dimension;
    OverlapKind kind;
  } cells[] = {{0, kEmpty, kNone},     {0, kPoint, kTouch},   {0, kPoint, kPierce}, {0, kSegment, kTouch},
               {0, kSegment, kPierce}, {0, kArea, kCoplanar}, {1, kPoint, kNone},   {1, kSegment, kTouch},
               {1, kSegment, kPierce}, {1, kArea, kCoplanar}, {2, kPoint, kNone},   {2, kSegment, kNone},
               {2, kSegment, kTouch},  {2, kArea, kFold},     {3, kPoint, kSame},   {3, kSegment, kSame},
               {3, kArea, kSame}};
  for (const auto& [shared, dimension, kind] : cells) {
    EXPECT_GT(all.pairs[shared][dimension][static_cast<std::size_t>(kind)], 0)
        << shared << " shared, dimension " << static_cast<int>(dimension) - 1 << ", " << name_of(kind);
  }
  for (const long count : all.by_degenerate) EXPECT_GT(count, 1000);
  EXPECT_GT(all.duplicates, 1000);
}

}  // namespace selvage::verify
