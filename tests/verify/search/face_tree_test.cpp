// The first filter of the frame check: it finds the pairs that brute force finds, and what it proves is so.
#include "verify/search/face_tree.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <tuple>

#include <gmpxx.h>
#include <gtest/gtest.h>

#include "verify/decision/exact_overlap.h"

namespace selvage::verify {
namespace {

using Random = std::mt19937_64;
using Triangle = std::array<std::int32_t, 3>;

struct Mesh {
  std::vector<Triangle> triangles;
  std::vector<Point> V;

  [[nodiscard]] std::array<Point, 3> corners(std::int32_t f) const {
    const auto& [a, b, c] = triangles[static_cast<std::size_t>(f)];
    const auto at = [&](std::int32_t v) { return V[static_cast<std::size_t>(v)]; };
    return {at(a), at(b), at(c)};
  }
};

double uniform(Random& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Faces over few vertices, so that all ways of sharing occur. `point` places a vertex.
template <class PointOf>
Mesh random_mesh(Random& random, std::int32_t vertices, std::size_t faces, const PointOf& point) {
  Mesh mesh;
  for (std::int32_t v = 0; v < vertices; ++v) mesh.V.push_back(point());
  while (mesh.triangles.size() < faces) {
    const auto any = [&] { return static_cast<std::int32_t>(random() % static_cast<std::uint64_t>(vertices)); };
    const Triangle t = {any(), any(), any()};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) mesh.triangles.push_back(t);
  }
  return mesh;
}

Mesh lattice_mesh(Random& random) {
  const auto coordinate = [&] { return static_cast<double>(random() % 4); };
  return random_mesh(random, 20, 60, [&] { return Point{coordinate(), coordinate(), coordinate()}; });
}
/// Differences that single precision does not see.
Mesh nudged_mesh(Random& random) {
  const auto coordinate = [&] { return static_cast<double>(random() % 4) + 0x1p-40 * uniform(random, -1, 1); };
  return random_mesh(random, 20, 60, [&] { return Point{coordinate(), coordinate(), coordinate()}; });
}
Mesh planar_mesh(Random& random) {  // in one plane along no axis, most points an ulp beside it
  return random_mesh(random, 20, 60, [&] {
    const double x = uniform(random, 0, 1), y = uniform(random, 0, 1);
    return Point{x, y, 0.3 * x + 0.7 * y};
  });
}
/// A strip of small faces, neighbours in space and by index.
Mesh strip(Random& random, double bend) {
  Mesh mesh;
  for (std::int32_t i = 0; i < 16; ++i) {
    for (int j = 0; j < 3; ++j) mesh.V.push_back({0.01 * i, 0.01 * j, bend * uniform(random, -1, 1)});
  }
  for (std::int32_t i = 0; i < 15; ++i) {
    for (std::int32_t j = 0; j < 2; ++j) {
      const std::int32_t a = 3 * i + j;
      mesh.triangles.push_back({a, a + 3, a + 1});
      mesh.triangles.push_back({a + 3, a + 4, a + 1});
    }
  }
  return mesh;
}
Mesh placed(Mesh mesh, double scale, double shift) {
  for (Point& p : mesh.V) {
    for (double& x : p) x = x * scale + shift;
  }
  return mesh;
}

struct Found {
  std::map<std::array<std::int32_t, 2>, bool> pairs;  // visited, and whether apart
  std::int64_t counted = 0;
};

Found find(const Mesh& mesh, const FloatFrame& frame, const std::vector<std::int32_t>& a,
           const std::vector<std::int32_t>* b, bool each) {
  const FaceTree tree(a, mesh.triangles, mesh.V, frame);
  struct Visit {
    Found& found;
    void operator()(std::int64_t count) const { found.counted += count; }
    void operator()(std::int32_t f, std::int32_t g, bool apart) const {
      EXPECT_TRUE(found.pairs.emplace(std::array{std::min(f, g), std::max(f, g)}, apart).second) << "visited twice";
    }
  };
  Found found;
  const auto other =
      b == nullptr ? FaceTree({}, mesh.triangles, mesh.V, frame) : FaceTree(*b, mesh.triangles, mesh.V, frame);
  for (std::size_t group = 0; group < tree.group_count(); ++group) {
    if (b == nullptr) {
      tree.visit_pairs_within(group, each, Visit{found});
    } else {
      tree.visit_pairs_between(group, other, each, Visit{found});
    }
  }
  return found;
}

std::vector<std::array<std::int32_t, 2>> brute_force(const Mesh& mesh, const std::vector<std::int32_t>& a,
                                                     const std::vector<std::int32_t>* b) {
  std::vector<std::array<std::int32_t, 2>> pairs;
  for (const std::int32_t f : a) {
    for (const std::int32_t g : b == nullptr ? a : *b) {
      if (b == nullptr && f >= g) continue;
      if (bounding_box(mesh.corners(f)).overlaps(bounding_box(mesh.corners(g)))) {
        pairs.push_back({std::min(f, g), std::max(f, g)});
      }
    }
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

std::vector<Mesh> meshes() {
  Random random(4);
  std::vector<Mesh> all;
  for (int i = 0; i < 10; ++i) {
    for (const Mesh& mesh : {lattice_mesh(random), nudged_mesh(random), planar_mesh(random), strip(random, 0.01),
                             strip(random, 1e-9), random_mesh(random, 30, 60, [&] {
                               return Point{uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
                             })}) {
      all.push_back(mesh);
      all.push_back(placed(mesh, 1, 1e3));
      all.push_back(placed(mesh, 0x1p-1060, 0));
      all.push_back(placed(mesh, 0x1p-1074, 0));
      all.push_back(placed(mesh, 0x1p+1020, 0));
    }
  }
  all.push_back(placed(all.front(), 0, 5));  // all vertices at one point
  // Several groups, and more blocks that overlap than are compared at once.
  all.push_back(random_mesh(random, 200, 280, [&] {
    return Point{uniform(random, 0, 1), uniform(random, 0, 1), uniform(random, 0, 1)};
  }));
  return all;
}

}  // namespace

TEST(FaceTree, FindsThePairsOfBruteForceAndProvesNothingThatIsNotSo) {
  std::int64_t proved = 0, proved_in_part = 0, neighbours_proved = 0, unknown = 0;
  for (const Mesh& mesh : meshes()) {
    std::vector<std::int32_t> all(mesh.triangles.size()), even, odd;
    std::iota(all.begin(), all.end(), 0);
    for (const std::int32_t f : all) (f % 2 == 0 ? even : odd).push_back(f);
    const FloatFrame whole = FloatFrame::over(bounding_box(mesh.V));
    const FloatFrame part = FloatFrame::over(bounding_box(std::span(mesh.V).first(8)));
    const std::vector<std::int32_t>* const none = nullptr;
    for (const auto& [a, b, frame] :
         {std::tuple{&all, none, &whole}, {&even, &odd, &whole}, {&all, none, &part}, {&even, &odd, &part}}) {
      const Found each = find(mesh, *frame, *a, b, true), some = find(mesh, *frame, *a, b, false);
      std::vector<std::array<std::int32_t, 2>> pairs;
      std::int64_t apart_count = 0;
      for (const auto& [pair, apart] : each.pairs) {
        pairs.push_back(pair);
        apart_count += apart ? 1 : 0;
        if (!apart) {
          ++unknown;
          EXPECT_EQ(some.pairs.count(pair), 1U);
          continue;
        }
        ++(frame == &whole ? proved : proved_in_part);
        const Triangle &t = mesh.triangles[static_cast<std::size_t>(pair[0])],
                       &u = mesh.triangles[static_cast<std::size_t>(pair[1])];
        neighbours_proved += std::find_first_of(t.begin(), t.end(), u.begin(), u.end()) != t.end() ? 1 : 0;
        ASSERT_EQ(exact_overlap(t, mesh.corners(pair[0]), u, mesh.corners(pair[1])).kind, OverlapKind::kNone);
      }
      ASSERT_EQ(pairs, brute_force(mesh, *a, b));
      EXPECT_EQ(each.counted, 0);
      EXPECT_EQ(some.counted, apart_count);
      EXPECT_EQ(some.pairs.size(), each.pairs.size() - static_cast<std::size_t>(apart_count));
    }
  }
  EXPECT_GT(proved, 20'000);
  EXPECT_GT(proved_in_part, 1'000);
  EXPECT_GT(neighbours_proved, 5'000);
  EXPECT_GT(unknown, 20'000);
}

namespace {

using Rational3 = std::array<mpq_class, 3>;

/// X of FloatFrame, exactly.
Rational3 exact(const FloatFrame& frame, const Point& p) {
  Rational3 x;
  for (std::size_t k = 0; k < 3; ++k) {
    x[k] = (mpq_class(p[k]) / 2 - mpq_class(frame.center_half[k])) * mpq_class(frame.scale);
  }
  return x;
}

/// What the bound speaks of, over the bound: n . (x - s) against the difference of the computed projections, for the
/// corner s with the highest one.
double used_share(const std::array<Point, 4>& points, const FloatFrame& frame) {
  const FloatFace face({0, 1, 2}, points, frame);
  const auto project = [&](std::size_t i) {
    const Point& p = points[i];
    const auto& u = face.direction;
    return u[0] * frame(0, p[0]) + u[1] * frame(1, p[1]) + u[2] * frame(2, p[2]);
  };
  std::size_t s = 0;
  for (const std::size_t i : {1U, 2U}) s = project(i) > project(s) ? i : s;
  const Rational3 a = exact(frame, points[0]), b = exact(frame, points[1]), c = exact(frame, points[2]);
  const Rational3 from = exact(frame, points[s]), to = exact(frame, points[3]);
  mpq_class height = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    const mpq_class n = (b[i] - a[i]) * (c[j] - a[j]) - (b[j] - a[j]) * (c[i] - a[i]);
    height += n * (to[k] - from[k]);
  }
  const mpq_class error = abs(height - (mpq_class(project(3)) - mpq_class(project(s))));
  return mpq_class(error / (mpq_class(face.high) - mpq_class(project(s)))).get_d();
}

}  // namespace

TEST(FloatFace, ErrorsReachAFairShareOfTheirBoundAndNeverAllOfIt) {
  Random random(11);
  double worst = 0;
  for (int start = 0; start < 40; ++start) {
    const double size = std::exp2(uniform(random, -14, 0));
    std::array<Point, 4> points;
    const Point center = {uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1)};
    const FloatFrame frame = FloatFrame::over({{-3, -3, -3}, {3, 3, 3}});
    const auto place = [&](std::size_t i, std::size_t k) {
      points[i][k] = i < 3 ? center[k] + size * uniform(random, -1, 1) : uniform(random, -3, 3);
    };
    for (std::size_t i = 0; i < 12; ++i) place(i / 3, i % 3);
    double best = used_share(points, frame);
    for (int step = 0; step < 400; ++step) {  // a climb towards the worst rounding
      const auto kept = points;
      place(random() % 4, random() % 3);
      const double share = used_share(points, frame);
      if (share > best) {
        best = share;
      } else {
        points = kept;
      }
    }
    worst = std::max(worst, best);
  }
  RecordProperty("used_percent", static_cast<int>(100 * worst));
  EXPECT_LT(worst, 1);
  EXPECT_GT(worst, 0.05);
}

}  // namespace selvage::verify
