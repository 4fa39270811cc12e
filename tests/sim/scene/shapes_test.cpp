#include "sim/scene/shapes.h"

#include <map>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "sim/cloth.h"
#include "tests/sim/scene/shape_topology.h"

namespace selvage {

using namespace sim;
using testbed::closed_and_oriented;
using testbed::directed_edges;

namespace {

// Positive if the faces are counter-clockwise seen from outside.
double volume(const Shape& shape) {
  double sum = 0;
  for (const auto& t : shape.triangles) {
    const Vec3 a = shape.x.row(t[0]), b = shape.x.row(t[1]), c = shape.x.row(t[2]);
    sum += a.dot(b.cross(c)) / 6;
  }
  return sum;
}

}  // namespace

TEST(Shapes, BoxIsClosedAndHasItsVolume) {
  for (const std::int32_t cells : {1, 2, 5}) {
    const Shape box = make_box({1, 2, 3}, cells);
    EXPECT_EQ(box.x.rows(), 6 * cells * cells + 2);
    EXPECT_EQ(box.triangles.size(), static_cast<std::size_t>(12 * cells * cells));
    EXPECT_TRUE(closed_and_oriented(box));
    EXPECT_NEAR(volume(box), 6, 1e-12);
  }
}

TEST(Shapes, SphereIsClosedAndTendsToItsVolume) {
  const Shape sphere = make_sphere(2, 4);
  EXPECT_EQ(sphere.x.rows(), 2562);
  EXPECT_EQ(sphere.triangles.size(), 5120u);
  EXPECT_TRUE(closed_and_oriented(sphere));
  EXPECT_NEAR(volume(sphere), 4.0 / 3 * std::numbers::pi * 8, 0.2);
  for (Eigen::Index i = 0; i < sphere.x.rows(); ++i) EXPECT_NEAR(sphere.x.row(i).norm(), 2, 1e-14);
}

TEST(Shapes, EllipsoidIsClosedAndTendsToItsVolume) {
  const Vec3 size(0.4, 1, 3);
  const Shape ellipsoid = make_ellipsoid(size, 4);
  EXPECT_TRUE(closed_and_oriented(ellipsoid));
  EXPECT_NEAR(volume(ellipsoid), std::numbers::pi / 6 * size.prod(), 0.01 * size.prod());
  for (Eigen::Index i = 0; i < ellipsoid.x.rows(); ++i) {
    EXPECT_NEAR(Vec3(ellipsoid.x.row(i).transpose().cwiseQuotient(size)).norm(), 0.5, 1e-14);
  }
}

namespace {

// To the union of all spheres whose centre and radius are interpolated between the two ends: the least of a convex
// function of the place between them.
double distance_to_capsule(const Vec3& p, const Vec3& end_m, double radius_m, double end_radius_m) {
  const auto at = [&](double t) { return (p - t * end_m).norm() - ((1 - t) * radius_m + t * end_radius_m); };
  double lower = 0, upper = 1;
  for (int n = 0; n < 80; ++n) {
    const double a = lower + (upper - lower) / 3, b = upper - (upper - lower) / 3;
    if (at(a) < at(b)) {
      upper = b;
    } else {
      lower = a;
    }
  }
  return at(lower);
}

}  // namespace

TEST(Shapes, CapsuleIsClosedAndItsVerticesLieOnIt) {
  struct Case {
    Vec3 end_m;
    double radius_m, end_radius_m;
  };
  for (const auto& [end_m, radius_m, end_radius_m] :
       {Case{{0, 0, -0.4}, 0.08, 0.05}, Case{{0.3, 0.1, 0}, 0.05, 0.05}, Case{{0.02, -0.03, 0.1}, 0.01, 0.1}}) {
    for (const std::int32_t segments : {3, 8, 33}) {
      const Shape capsule = make_capsule(end_m, radius_m, end_radius_m, segments);
      EXPECT_TRUE(closed_and_oriented(capsule));
      EXPECT_GT(volume(capsule), 0);
      for (Eigen::Index i = 0; i < capsule.x.rows(); ++i) {
        ASSERT_NEAR(distance_to_capsule(capsule.x.row(i), end_m, radius_m, end_radius_m), 0, 1e-12);
      }
    }
  }
  const Shape fine = make_capsule({0, 0, 2}, 0.5, 0.5, 200);
  EXPECT_NEAR(volume(fine), std::numbers::pi * (0.25 * 2 + 4.0 / 3 * 0.125), 2e-3);
}

TEST(Shapes, SheetFacesUpAndHasItsArea) {
  const Shape sheet = make_sheet(4, 3, 1.5, 1);
  EXPECT_EQ(sheet.x.rows(), 12);
  EXPECT_EQ(sheet.triangles.size(), 12u);
  double area = 0;
  for (const auto& t : sheet.triangles) {
    const Vec3 a = sheet.x.row(t[0]), b = sheet.x.row(t[1]), c = sheet.x.row(t[2]);
    EXPECT_GT((b - a).cross(c - a).z(), 0);
    area += (b - a).cross(c - a).z() / 2;
  }
  EXPECT_NEAR(area, 1.5, 1e-14);
  for (const auto& [edge, count] : directed_edges(sheet)) EXPECT_EQ(count, 1);
}

TEST(Cloth, SheetHasThePapersSprings) {
  ClothSpec spec{
      // at once: of an assignment GCC 12 may say that the surface was not initialized
      .name = {}, .surface = SheetSpec{4, 3, 3, 2}, .placement = {}, .stiffest_key = {}, .pins = {}, .contact = {}};
  spec.density_kg_m2 = 0.2;
  spec.stretch_n_m = 10;
  spec.shear_n_m = 5;
  spec.bend_n_m = 1;
  spec.damping_ratio = 0.5;
  const Shape rest = make_sheet(4, 3, 3, 2);
  const std::vector<double> mass = cloth_masses(spec, rest);
  for (const double m : mass) EXPECT_NEAR(m, 0.2 * 6 / 12, 1e-15);  // section 3: equal masses
  std::map<SpringKind, int> count;
  for (const Spring& spring : make_springs(spec, rest, mass)) {
    ++count[spring.kind];
    EXPECT_NEAR(spring.damping_n_s_m, 0.5 * 2 * std::sqrt(spring.stiffness_n_m * mass[0] / 2), 1e-15);
    EXPECT_EQ(spring.rest_length_m, (rest.x.row(spring.a) - rest.x.row(spring.b)).norm());
  }
  EXPECT_EQ(count[SpringKind::kStructural], 3 * 3 + 4 * 2);
  EXPECT_EQ(count[SpringKind::kShear], 2 * 3 * 2);
  EXPECT_EQ(count[SpringKind::kBending], 2 * 3 + 4 * 1);
}

TEST(Cloth, VerticesOfNoFaceTakeNoMassFromTheOthers) {
  ClothSpec spec;
  spec.density_kg_m2 = 0.2;
  Shape rest = make_sheet(4, 3, 3, 2);
  rest.x.conservativeResize(100, 3);
  rest.x.bottomRows(88).setConstant(7);
  for (const double m : cloth_masses(spec, rest)) EXPECT_NEAR(m, 0.2 * 6 / 12, 1e-15);
  rest.triangles.clear();
  for (const double m : cloth_masses(spec, rest)) EXPECT_EQ(m, 0);
}

TEST(Cloth, WhatIsNotAskedForIsNotBuilt) {
  ClothSpec spec;
  spec.surface = SheetSpec{4, 3, 3, 2};
  spec.stretch_n_m = 10;
  const Shape rest = make_sheet(4, 3, 3, 2);
  EXPECT_EQ(make_springs(spec, rest, std::vector<double>(12, 1.0)).size(), 17u);
}

TEST(Cloth, MeshHasSpringsAlongEdgesAndAcrossInnerOnes) {
  ClothSpec spec;
  spec.surface = MeshSpec{};
  spec.stretch_n_m = 10;
  spec.bend_n_m = 1;
  spec.density_kg_m2 = 3;
  spec.masses = ClothSpec::Masses::kArea;
  Shape rest;  // two faces that share the edge (1, 2), areas 1/2 and 3/2
  rest.x.resize(4, 3);
  rest.x << 0, 0, 0, 1, 0, 0, 0, 1, 0, 2, 2, 0;
  rest.triangles = {{0, 1, 2}, {1, 3, 2}};
  const std::vector<double> mass = cloth_masses(spec, rest);
  EXPECT_NEAR(mass[0], 0.5, 1e-15);
  EXPECT_NEAR(mass[1], 2, 1e-15);
  const std::vector<Spring> springs = make_springs(spec, rest, mass);
  ASSERT_EQ(springs.size(), 6u);
  const auto bending = std::find_if(springs.begin(), springs.end(),
                                    [](const Spring& spring) { return spring.kind == SpringKind::kBending; });
  ASSERT_NE(bending, springs.end());
  EXPECT_EQ(std::min(bending->a, bending->b), 0);
  EXPECT_EQ(std::max(bending->a, bending->b), 3);
}

}  // namespace selvage
