#include "sim/scene/garment.h"

#include <numbers>
#include <set>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/sim/scene/shape_topology.h"
#include "verify/check.h"

namespace selvage {

using namespace sim;
using testbed::directed_edges;

namespace {

GarmentSpec robe(double cell_m) {
  GarmentSpec spec;
  spec.rings = {{1.5, 0.2, 0.22}, {1.43, 0.34, 0.5}, {1.1, 0.38, 0.54}, {0.25, 0.84, 0.88}};
  spec.sleeves = GarmentSpec::Sleeves{1.4, 1.1, 0.22, 0.46, 0.13, 50};
  spec.cell_m = cell_m;
  return spec;
}

GarmentSpec skirt(double cell_m) {
  GarmentSpec spec;
  spec.rings = {{1, 0.2, 0.3}, {0.4, 0.6, 0.6}};
  spec.cell_m = cell_m;
  return spec;
}

using Loop = std::set<std::int32_t>;

// Fails where an edge has two faces to one side, or a vertex lies on two borders.
std::vector<Loop> border_loops(const Shape& shape) {
  std::map<std::int32_t, std::int32_t> next;
  const auto edges = directed_edges(shape);
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1) << "at the edge " << edge[0] << ", " << edge[1];
    if (edges.contains({edge[1], edge[0]})) continue;
    EXPECT_TRUE(next.emplace(edge[1], edge[0]).second) << "at vertex " << edge[1];
  }
  std::vector<Loop> loops;
  while (!next.empty()) {
    Loop loop;
    for (auto at = next.begin(); at != next.end();) {
      loop.insert(at->first);
      const std::int32_t following = at->second;
      next.erase(at);
      at = next.find(following);
    }
    loops.push_back(loop);
  }
  return loops;
}

std::int64_t euler_characteristic(const Shape& shape) {
  std::set<std::array<std::int32_t, 2>> edges;
  for (const auto& [edge, count] : directed_edges(shape)) {
    edges.insert({std::min(edge[0], edge[1]), std::max(edge[0], edge[1])});
  }
  return shape.x.rows() - static_cast<std::int64_t>(edges.size()) + static_cast<std::int64_t>(shape.triangles.size());
}

// By spreading from vertex 0 along faces.
bool is_connected(const Shape& shape) {
  std::vector<std::uint8_t> reached(static_cast<std::size_t>(shape.x.rows()));
  reached[0] = 1;
  for (bool grew = true; grew;) {
    grew = false;
    for (const auto& t : shape.triangles) {
      const bool touched = std::any_of(t.begin(), t.end(), [&](auto v) { return reached[std::size_t(v)] != 0; });
      for (const std::int32_t v : t) {
        if (!touched || reached[std::size_t(v)] != 0) continue;
        reached[std::size_t(v)] = 1;
        grew = true;
      }
    }
  }
  return std::find(reached.begin(), reached.end(), 0) == reached.end();
}

std::int64_t intersections(const Shape& shape) {
  std::vector<verify::Point> points;
  for (Eigen::Index i = 0; i < shape.x.rows(); ++i) points.push_back({shape.x(i, 0), shape.x(i, 1), shape.x(i, 2)});
  const std::vector<std::uint8_t> no_bodies;
  return verify::check_frame(verify::Surface{shape.triangles, no_bodies}, points, {}).violations_total.total();
}

bool on_ring(const Shape& shape, const Loop& loop, const GarmentSpec::Ring& ring) {
  return std::all_of(loop.begin(), loop.end(), [&](std::int32_t v) {
    const Vec3 p = shape.x.row(v);
    const double part = std::hypot(2 * p.x() / ring.depth_m, 2 * p.y() / ring.width_m);
    return std::abs(p.z() - ring.height_m) < 1e-12 && std::abs(part - 1) < 1e-12;
  });
}

// A flat circle of the radius, at right angles to a sleeve of the side, at its length from the opening, whose middle
// lies up to 8 cm from where a flat one would be: the side is round, and it begins and ends with a cell.
bool on_cuff(const Shape& shape, const Loop& loop, const GarmentSpec& spec, double side) {
  const GarmentSpec::Sleeves& sleeves = *spec.sleeves;
  const double down = sleeves.down_deg * std::numbers::pi / 180;
  const Vec3 along(0, side * std::cos(down), -std::sin(down));
  const Vec3 first = shape.x.row(*loop.begin());
  double across = 0;
  Vec3 middle = Vec3::Zero();
  for (const std::int32_t v : loop) {
    const Vec3 p = shape.x.row(v);
    middle += p / double(loop.size());
    if (std::abs((p - first).dot(along)) > 1e-12) return false;
    across = std::max(across, (p - first).norm());
  }
  const Vec3 opening(0, side * spec.rings.at(2).width_m / 2, (sleeves.top_m + sleeves.bottom_m) / 2);
  return (middle - opening - sleeves.length_m * along).norm() < 0.08 && across <= 2 * sleeves.cuff_radius_m + 1e-12 &&
         across > 1.8 * sleeves.cuff_radius_m;
}

}  // namespace

TEST(Garment, IsOneOpenSurfaceWithoutIntersectionAtEveryResolution) {
  for (const double cell_m : {0.09, 0.06, 0.034, 0.021, 0.0125}) {
    const GarmentSpec spec = robe(cell_m);
    const Shape shape = make_garment(spec);
    EXPECT_TRUE(is_connected(shape));
    EXPECT_EQ(euler_characteristic(shape), -2) << "a sphere with four holes";
    EXPECT_EQ(intersections(shape), 0) << "cell_m " << cell_m;
    const std::vector<Loop> loops = border_loops(shape);
    ASSERT_EQ(loops.size(), 4u);
    const auto count = [&](auto is_border) { return std::count_if(loops.begin(), loops.end(), is_border); };
    EXPECT_EQ(count([&](const Loop& loop) { return on_ring(shape, loop, spec.rings.front()); }), 1) << "the neck";
    EXPECT_EQ(count([&](const Loop& loop) { return on_ring(shape, loop, spec.rings.back()); }), 1) << "the hem";
    for (const double side : {-1, 1}) {
      EXPECT_EQ(count([&](const Loop& loop) { return on_cuff(shape, loop, spec, side); }), 1) << "a cuff";
    }
  }
}

TEST(Garment, CellsHaveTheSizeThatIsAskedFor) {
  for (const double cell_m : {0.05, 0.025}) {
    const Shape shape = make_garment(robe(cell_m));
    double area = 0;
    for (const auto& t : shape.triangles) {
      const Vec3 a = shape.x.row(t[0]), b = shape.x.row(t[1]), c = shape.x.row(t[2]);
      area += (b - a).cross(c - a).norm() / 2;
    }
    EXPECT_NEAR(std::sqrt(2 * area / double(shape.triangles.size())) / cell_m, 1, 0.15);
  }
}

TEST(Garment, WithoutSleevesIsATubeThatFacesOutward) {
  const Shape shape = make_garment(skirt(0.05));
  EXPECT_EQ(border_loops(shape).size(), 2u);
  EXPECT_EQ(euler_characteristic(shape), 0);
  for (const auto& t : shape.triangles) {
    const Vec3 a = shape.x.row(t[0]), b = shape.x.row(t[1]), c = shape.x.row(t[2]), middle = (a + b + c) / 3;
    EXPECT_GT((b - a).cross(c - a).dot(Vec3(middle.x(), middle.y(), 0)), 0);
  }
}

TEST(Garment, IsTheSameOnBothSides) {
  const Shape shape = make_garment(robe(0.05));
  std::vector<std::array<double, 3>> left, right;
  for (Eigen::Index i = 0; i < shape.x.rows(); ++i) {
    const auto rounded = [](double v) { return std::round(v * 1e9) / 1e9; };
    const double x = rounded(shape.x(i, 0)), y = rounded(shape.x(i, 1)), z = rounded(shape.x(i, 2));
    (y > 0 ? left : right).push_back({x, std::abs(y), z});
    if (y == 0) left.push_back({x, 0, z});
  }
  std::sort(left.begin(), left.end());
  std::sort(right.begin(), right.end());
  EXPECT_EQ(left, right);
}

TEST(Garment, RefusesOpeningsThatCannotBeCut) {
  const auto fails_with = [](const char* words, auto change) {
    GarmentSpec spec = robe(0.05);
    change(*spec.sleeves);
    try {
      (void)make_garment(spec);
      ADD_FAILURE() << words;
    } catch (const GarmentError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  fails_with("above or below", [](auto& sleeves) { sleeves.top_m = 1.6; });
  fails_with("above or below", [](auto& sleeves) { sleeves.bottom_m = 0.2; });
  fails_with("lower than a cell", [](auto& sleeves) { sleeves.bottom_m = sleeves.top_m; });
  fails_with("deeper than", [](auto& sleeves) { sleeves.depth_m = 0.5; });
  fails_with("narrower than", [](auto& sleeves) { sleeves.depth_m = 0.01; });
  fails_with("meet", [](auto& sleeves) { sleeves.depth_m = 0.3625; });
}

}  // namespace selvage
