// The repair of a start, judged by the exact checker: clean, or an honest no.
#include "sim/repair/untangle.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "tests/fp_control.h"
#include "tests/sim/repair/untangle_scene.h"

namespace selvage::sim::testbed {
namespace {

StepScene interpenetrating_layers() {
  StepScene scene;
  scene.add(make_sheet(13, 13, 0.3, 0.3), Vec3::Zero());
  const StepScene::Part upper = scene.add(make_sheet(12, 12, 0.28, 0.28), Vec3(0.003, 0.002, 0.001));
  for (VertexId v = upper.begin; v < upper.end; ++v) {
    scene.V_t0(v, 2) += 0.006 * std::sin(40 * scene.V_t0(v, 0)) * std::cos(30 * scene.V_t0(v, 1));
  }
  return scene;
}

}  // namespace

TEST(Untangle, WhatIsCleanIsReturnedAsItIs) {
  StepScene scene;
  scene.add(make_sheet(5, 5, 0.1, 0.1), Vec3::Zero());
  scene.add(make_sheet(5, 5, 0.1, 0.1), Vec3(0, 0, 1e-9));
  const UntangleResult result = untangle_scene(scene);
  EXPECT_EQ(result.x, scene.V_t0);
  EXPECT_EQ(result.report.rounds, 1);
  EXPECT_EQ(defect_of(scene, result), "");
}

TEST(Untangle, WhatACollisionStepRefusesIsAskedBeforeAnythingMoves) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const StepScene sound = interpenetrating_layers();
  const auto attempt = [](const StepScene& scene, const UntangleOptions& options, const FindIntersections& find) {
    const StepScene whole = interpenetrating_layers();
    static_cast<void>(untangle(whole.mesh(), scene.V_t0, scene.bodies(), options, find));
  };
  const FindIntersections judge = exact_judge(sound);
  const auto expect_refused = [&](const auto& spoil) {
    StepScene scene = sound;
    UntangleOptions options;
    spoil(scene, options);
    EXPECT_DEATH(attempt(scene, options, judge), "untangle is called without what it requires");
  };
  expect_refused([](StepScene&, UntangleOptions& options) { options.gap_m = 0; });
  expect_refused([](StepScene&, UntangleOptions& options) { options.gap_m = kNan; });
  expect_refused([](StepScene&, UntangleOptions& options) { options.tolerance_m = kNan; });
  expect_refused([](StepScene& scene, UntangleOptions&) { scene.inverse_mass.clear(); });
  expect_refused([](StepScene& scene, UntangleOptions&) { scene.inverse_mass.resize(3); });
  expect_refused([](StepScene& scene, UntangleOptions&) { scene.inverse_mass[0] = -1; });
  expect_refused([](StepScene& scene, UntangleOptions&) { scene.body.resize(2); });
  expect_refused([](StepScene& scene, UntangleOptions&) { scene.V_t0 = Positions(scene.V_t0.topRows(5)); });
  expect_refused([](StepScene& scene, UntangleOptions&) { scene.V_t0(0, 0) = kNan; });
  expect_refused([](StepScene& scene, UntangleOptions&) { scene.V_t0(0, 0) = 1e305; });
  expect_refused([](StepScene& scene, UntangleOptions& options) {
    scene.V_t0(0, 0) = 0.1;
    options.precision = Precision::kFloat32;
  });
  expect_refused([](StepScene&, UntangleOptions& options) {
    options.surfaces.properties = {{}};
    options.surfaces.surface_of_vertex = {0};
  });
  const auto last = static_cast<FaceId>(sound.triangles.size()) - 1;
  for (const FacePair& beyond : {FacePair{0, last + 1}, FacePair{-1, 0}}) {
    const FindIntersections lies = [beyond](const Positions&) { return std::vector<FacePair>{beyond}; };
    EXPECT_DEATH(attempt(sound, {}, lies), "judge is called without what it requires: .*is_face");
  }
}

TEST(Untangle, LayersThatInterpenetrate) { expect_repaired(interpenetrating_layers(), 0.02); }

TEST(Untangle, SameBitsWhateverRoundingTheCallerHas) {
  const StepScene scene = interpenetrating_layers();
  const UntangleResult expected = untangle_scene(scene);
  const unsigned before = selvage::testing::fp_control();
  selvage::testing::set_fp_control(before | selvage::testing::kRoundUp);
  const UntangleResult result = untangle_scene(scene);
  selvage::testing::set_fp_control(before);
  EXPECT_EQ(result.x, expected.x);
}

TEST(Untangle, ASheetThatStandsInAnother) {
  StepScene scene;
  scene.add(make_sheet(13, 13, 0.3, 0.3), Vec3::Zero());
  const StepScene::Part upper = scene.add(make_sheet(9, 9, 0.2, 0.2), Vec3::Zero());
  for (VertexId v = upper.begin; v < upper.end; ++v) {  // it stands upright, with its lowest quarter below
    scene.V_t0.row(v) = Eigen::RowVector3d(scene.V_t0(v, 0) + 0.004, 0.007, scene.V_t0(v, 1) + 0.05);
  }
  expect_repaired(scene, 0.08);
}

TEST(Untangle, SheetsThatLieInOnePlane) {
  StepScene scene;
  scene.add(make_sheet(5, 5, 0.1, 0.1), Vec3::Zero());
  scene.add(make_sheet(4, 4, 0.1, 0.1), Vec3(0.01, 0.013, 0));
  expect_repaired(scene, 0.002);
}

TEST(Untangle, ClothThatWasPulledPartlyThroughABall) {
  StepScene scene;
  scene.add(make_sheet(21, 21, 0.5, 0.5), Vec3(0.003, 0.002, 0.07));
  scene.add(make_sphere(0.1, 2), Vec3::Zero(), 0);
  expect_repaired(scene, 0.05);
}

TEST(Untangle, ClothThroughTheMiddleOfABall) {
  StepScene scene;
  scene.add(make_sheet(13, 13, 0.5, 0.5), Vec3(0.003, 0.002, 0.001));
  scene.add(make_sphere(0.1, 1), Vec3::Zero(), 0);
  expect_repaired(scene, 0.15);
}

Shape turned_inside_out(Shape shape) {
  for (auto& t : shape.triangles) std::swap(t[1], t[2]);
  return shape;
}

TEST(Untangle, WhichWayRoundFacesOfBodiesGoDoesNotMatter) {
  for (const bool is_turned : {false, true}) {
    SCOPED_TRACE(is_turned);
    const auto body = [&](const Shape& shape) { return is_turned ? turned_inside_out(shape) : shape; };
    StepScene ball;
    ball.add(make_sheet(13, 13, 0.3, 0.3), Vec3(0.003, 0.002, 0.07));
    ball.add(body(make_sphere(0.1, 2)), Vec3::Zero(), 0);
    expect_repaired(ball, 0.05);
    // Most of the sheet is above the ground; all is in the end.
    StepScene ground;
    const StepScene::Part tilted = ground.add(make_sheet(9, 9, 0.3, 0.3), Vec3::Zero());
    for (VertexId v = 0; v < tilted.end; ++v) ground.V_t0(v, 2) = 0.015 + 0.13 * ground.V_t0(v, 1);
    ground.add(body(make_sheet(2, 2, 2, 2)), Vec3(0.01, 0.02, 0), 0);
    const UntangleResult result = untangle_scene(ground);
    EXPECT_EQ(defect_of(ground, result), "");
    EXPECT_TRUE(result.report.remaining.empty());
    EXPECT_GT(result.x.topRows(tilted.end).col(2).minCoeff(), 0);
  }
}

TEST(Untangle, ClothWithinABoxWhoseFacesLookInwardsStaysThere) {
  StepScene scene;
  const StepScene::Part sheet =
      scene.add(make_sheet(9, 9, 0.5, 0.5), Vec3(0.76, 0.01, 0.02));  // through a wall by 1 cm
  scene.add(turned_inside_out(make_box(Vec3(2, 2, 2), 1)), Vec3::Zero(), 0);
  const UntangleResult result = untangle_scene(scene, 0.01);
  EXPECT_EQ(defect_of(scene, result), "");
  EXPECT_TRUE(result.report.remaining.empty());
  EXPECT_LT(result.x.topRows(sheet.end).col(0).maxCoeff(), 1);
  EXPECT_LT((result.x - scene.V_t0).rowwise().norm().maxCoeff(), 0.05);
}

// Parted along the normals of what crosses, whichever way those point.
TEST(Untangle, ClothIsNotPartedThroughTheGround) {
  for (const double turned_deg : {0.0, 180.0}) {
    for (const double apart_deg : {-10.0, 10.0}) {
      StepScene scene;
      for (const double angle_deg : {turned_deg, turned_deg + apart_deg}) {
        Shape sheet = make_sheet(8, 8, 1, 1);
        const double angle = angle_deg * std::numbers::pi / 180;
        for (auto row : sheet.x.rowwise()) row = Vec3(row.x(), std::cos(angle) * row.y(), std::sin(angle) * row.y());
        scene.add(sheet, Vec3(0, 0, 0.15));
      }
      scene.add(make_sheet(2, 2, 6, 6), Vec3::Zero(), 0);
      const UntangleResult result = untangle_scene(scene, 0.01);
      EXPECT_EQ(defect_of(scene, result), "");
      EXPECT_TRUE(result.report.remaining.empty());
      EXPECT_GT(result.x.topRows(128).col(2).minCoeff(), 0) << turned_deg << ", " << apart_deg;
    }
  }
}

// Two sheets in a closed box, by a judge for whom only sheets 0.46 m apart are free: the first shift that makes
// them so, 0.8 m, goes through a wall, which is 0.5 m away.
TEST(Untangle, ClothGoesThroughABodyWhereNothingElseHelps) {
  StepScene scene;
  scene.add(make_sheet(3, 3, 0.2, 0.2), Vec3::Zero());
  scene.add(make_sheet(3, 3, 0.2, 0.2), Vec3(0, 0, 0.05));
  scene.add(make_box(Vec3(1, 1, 1), 1), Vec3::Zero(), 0);
  const auto apart_m = [](const Positions& x) { return std::abs(x(0, 2) - x(9, 2)); };
  const FindIntersections judge = [&](const Positions& x) {
    return apart_m(x) > 0.46 ? std::vector<FacePair>{} : std::vector<FacePair>{{0, 8}};
  };
  UntangleOptions options;
  options.gap_m = 0.1;
  const UntangleResult result = untangle(scene.mesh(), scene.V_t0, scene.bodies(), options, judge);
  EXPECT_TRUE(result.report.remaining.empty());
  EXPECT_GT(apart_m(result.x), 0.46);
}

TEST(Untangle, NamesWhatIsSoAtTheStartWhateverATryMadeOfIt) {
  StepScene scene;
  scene.add(make_sheet(3, 3, 0.2, 0.2), Vec3::Zero());
  scene.add(make_sheet(3, 3, 0.2, 0.2), Vec3(0, 0, 0.05));
  const std::vector<FacePair> at_start{{0, 8}, {1, 9}, {2, 10}};
  const auto remaining = [&](const std::vector<FacePair>& after) {
    const FindIntersections judge = [&](const Positions& x) { return x == scene.V_t0 ? at_start : after; };
    UntangleResult result = untangle(scene.mesh(), scene.V_t0, scene.bodies(), {}, judge);
    EXPECT_EQ(result.x, scene.V_t0);
    return std::move(result.report.remaining);
  };
  EXPECT_EQ(remaining({{1, 9}, {3, 11}}), (std::vector<FacePair>{{1, 9}}));
  EXPECT_EQ(remaining({{3, 11}}), at_start) << "none of them, but others";
}

TEST(Untangle, ASheetCrossedByItsOwnCorner) {
  StepScene scene;
  const StepScene::Part sheet = scene.add(make_sheet(17, 17, 0.4, 0.4), Vec3::Zero());
  const Vec3 across = Vec3(1, 1, 0).normalized();
  for (VertexId v = sheet.begin; v < sheet.end; ++v) {
    const Vec3 x = scene.V_t0.row(v);
    const double beyond = x.dot(across) - 0.09;  // of the line along which the corner is folded back
    if (beyond > 0) scene.V_t0.row(v) = x - 2 * beyond * across + Vec3(0, 0, 1.5 * beyond * (0.12 - beyond));
  }
  expect_repaired(scene, 0.08);
}

/// A body may wait in a step of a simulation; one that waits on its way back from where it gave way would be left
/// there.
TEST(Untangle, BodiesComeBackWhateverThePolicy) {
  StepScene scene;
  Shape tetrahedron{Positions(4, 3), {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
  tetrahedron.x << 0, 0, 0, 0, 1, 0, 1, 0, 0, 0.2, 0.2, 0.3;
  scene.add(tetrahedron, Vec3::Zero(), 0);
  Shape through{Positions(3, 3), {{0, 1, 2}}};
  through.x << -1, -1, 0.1, 2, -1, 0.1, 0.3, 2, 0.1;
  const StepScene::Part pinned = scene.add(through, Vec3::Zero());
  for (VertexId v = pinned.begin; v < pinned.end; ++v) scene.inverse_mass[static_cast<std::size_t>(v)] = 0;
  for (const SqueezePolicy policy : {SqueezePolicy::kStop, SqueezePolicy::kYield}) {
    scene.policy = policy;
    const UntangleResult result = untangle_scene(scene);
    EXPECT_EQ(defect_of(scene, result), "");
    EXPECT_FALSE(result.report.remaining.empty()) << "all of it is scripted";
    EXPECT_EQ(result.x, scene.V_t0);
  }
}

TEST(Untangle, ClothThatIsPinnedInsideABodyIsLeftAsItIs) {
  StepScene scene;
  scene.add(make_sheet(9, 9, 0.3, 0.3), Vec3(0.003, 0.002, 0.02));
  scene.inverse_mass[40] = 0;  // the middle vertex
  scene.add(make_sphere(0.1, 1), Vec3::Zero(), 0);
  const UntangleResult result = untangle_scene(scene);
  EXPECT_FALSE(result.report.remaining.empty());
  EXPECT_EQ(result.x, scene.V_t0);
  EXPECT_EQ(defect_of(scene, result), "");
}

TEST(Untangle, WhatCouldBeRepairedIsNotWhereSomethingRemains) {
  StepScene scene;
  scene.add(make_sheet(9, 9, 0.3, 0.3), Vec3(0.003, 0.002, 0.02));
  scene.inverse_mass[40] = 0;
  scene.add(make_sheet(5, 5, 0.1, 0.1), Vec3(0.31, 0, 0.02));  // in the plane of the first, over its edge
  scene.add(make_sphere(0.1, 1), Vec3::Zero(), 0);
  scene.V_t0.middleRows(81, 25).col(0).array() -= 0.12;
  const UntangleResult result = untangle_scene(scene);
  EXPECT_FALSE(result.report.remaining.empty());
  const std::vector<FacePair> at_start = exact_judge(scene)(scene.V_t0);
  EXPECT_LT(result.report.remaining.size(), at_start.size()) << "the sheets alone could be";
  EXPECT_TRUE(std::ranges::includes(at_start, result.report.remaining)) << "it names what is so";
  EXPECT_EQ(defect_of(scene, result), "");
}

/// A sheet folded in two that is pinned, and a triangle through both halves. What crosses is drawn towards a membrane,
/// which no ring around the triangle spans: it is a part of its own. Far from the origin, where that would be seen.
TEST(Untangle, WhatNothingHoldsIsDrawnNowhere) {
  const Vec3 far(1000, 1000, 1000);
  StepScene scene;
  Shape folded = make_sheet(4, 2, 30, 10);
  for (Eigen::Index v = 0; v < folded.x.rows(); ++v) {
    const Eigen::Index column = v % 4;
    folded.x(v, 0) = column == 1 || column == 2 ? 10 : 0;
    folded.x(v, 2) = column < 2 ? 0 : 1;
  }
  scene.inverse_mass[static_cast<std::size_t>(scene.add(folded, far).begin)] = 0;
  Shape through{Positions(3, 3), {{0, 1, 2}}};
  through.x << 7, -3, -1, 7, -3, 2, 7.3, -2.9, 0.5;
  scene.add(through, far);

  double farthest_m = 0;
  const FindIntersections judge = exact_judge(scene);
  const FindIntersections watch = [&](const Positions& V) {
    farthest_m = std::max(farthest_m, (V - scene.V_t0).rowwise().norm().maxCoeff());
    return judge(V);
  };
  const UntangleResult result = untangle(scene.mesh(), scene.V_t0, scene.bodies(), {}, watch);
  EXPECT_EQ(defect_of(scene, result), "");
  EXPECT_GT(result.report.rounds, 2) << "the scene asks for something";
  EXPECT_GT(farthest_m, 0);
  EXPECT_LT(farthest_m, 100) << "a part may move as a whole by twice the size of the scene";
}

TEST(Untangle, Float32ResultsLieOnTheLattice) {
  StepScene scene;
  scene.add(make_sheet(9, 9, 0.3, 0.3), Vec3(0.003, 0.002, 0.07));
  scene.add(make_sphere(0.1, 1), Vec3::Zero(), 0);
  scene.options.precision = Precision::kFloat32;
  scene.V_t0 = scene.V_t0.cast<float>().cast<double>().eval();
  const UntangleResult result = untangle_scene(scene);
  EXPECT_TRUE(result.report.remaining.empty());
  EXPECT_EQ(result.x, result.x.cast<float>().cast<double>());
}

// Random small tangles of one to three sheets, crumpled, sometimes pinned, sometimes with a body. One draw a name: two
// in one expression were other scenes for every compiler.
TEST(Untangle, EndsCleanOrSaysWhatRemains) {
  int tangled = 0, repaired = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    std::mt19937 engine(seed);
    const auto between = [&](double lower, double upper) {
      return lower + (upper - lower) * (double(engine()) * 0x1p-32);
    };
    StepScene scene;
    const double crumple_m = between(0, 0.02);
    const int sheets = static_cast<int>(between(1, 4));
    for (int n = 0; n < sheets; ++n) {
      const int side = static_cast<int>(between(4, 9));
      const double z = between(-0.01, 0.01), y = between(-0.03, 0.03), x = between(-0.03, 0.03);
      const StepScene::Part part = scene.add(make_sheet(side, side, 0.1, 0.1), Vec3(x, y, z));
      for (VertexId v = part.begin; v < part.end; ++v) {
        for (int axis = 0; axis < 3; ++axis) scene.V_t0(v, axis) += crumple_m * between(-1, 1);
      }
      if (engine() % 8 == 0) scene.inverse_mass[static_cast<std::size_t>(part.begin)] = 0;
    }
    if (engine() % 2 == 0) {
      const double z = between(-0.05, 0.05), radius_m = between(0.01, 0.04);
      scene.add(make_sphere(radius_m, 1), Vec3(0.01, 0, z), 0);
    }
    const bool is_tangled = !exact_defect(scene, scene.V_t0).empty();
    const UntangleResult result = untangle_scene(scene);
    ASSERT_EQ(defect_of(scene, result), "") << seed;
    ASSERT_TRUE(is_tangled || result.x == scene.V_t0) << seed;
    ASSERT_LE(result.report.rounds, kMaxUntangleRounds + 4) << seed;
    tangled += is_tangled ? 1 : 0;
    repaired += is_tangled && result.report.remaining.empty() ? 1 : 0;
  }
  EXPECT_GT(tangled, 20);
  EXPECT_GE(repaired, tangled * 9 / 10) << "of " << tangled;
}

/// Thick cloth and a thick ball that overlap a little: left as near as thin ones, they would be thrown apart.
TEST(Untangle, PartsKeepTheTolerancesThatTheyHave) {
  for (const double tolerance_m : {1e-6, 0.008}) {
    StepScene scene;
    const StepScene::Part sheet = scene.add(make_sheet(12, 12, 0.3, 0.3), Vec3(0, 0, 0.099));
    scene.add(make_sphere(0.1, 2), Vec3::Zero(), 0);
    scene.surfaces.properties = {{.thickness_m = 0.01, .tolerance_m = tolerance_m}};
    scene.surfaces.surface_of_vertex.assign(static_cast<std::size_t>(scene.V_t0.rows()), 0);
    const UntangleResult result = untangle_scene(scene);
    EXPECT_EQ(defect_of(scene, result), "");
    EXPECT_TRUE(result.report.remaining.empty());
    const Mesh mesh = scene.mesh();
    BoxHierarchy hierarchy(mesh);
    double nearest_m = 1;
    for (const PairProximity& pair : find_proximities(mesh, hierarchy, result.x, 0.01)) {
      const auto vertices = pair_vertices(mesh, pair.kind, pair.first, pair.second);
      const bool is_between = std::ranges::any_of(vertices, [&](VertexId v) { return v < sheet.end; }) &&
                              std::ranges::any_of(vertices, [&](VertexId v) { return v >= sheet.end; });
      if (is_between) nearest_m = std::min(nearest_m, pair.proximity.distance);
    }
    if (tolerance_m > 1e-3) {
      EXPECT_GE(nearest_m, tolerance_m);
    } else {
      EXPECT_LT(nearest_m, 0.008) << "the scene asks for something";
    }
  }
}

}  // namespace selvage::sim::testbed
