// Thickness, tolerance and friction that differ from part to part: each pair has its own, in every stage.
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <utility>

#include "kernel/proximities.h"
#include "sim/contact/contact_table.h"
#include "tests/sim/step_scene.h"
#include "verify/distance_check.h"

namespace selvage::sim::testbed {
namespace {

std::int32_t surface_of(const StepScene& scene, VertexId v) {
  return scene.surfaces.surface_of_vertex[static_cast<std::size_t>(v)];
}

/// Adds a part of a surface of its own.
StepScene::Part add(StepScene& scene, const ContactProperties& properties, const Shape& shape, const Vec3& shift,
                    std::int32_t body = -1) {
  const StepScene::Part part = scene.add(shape, shift, body);
  scene.surfaces.surface_of_vertex.resize(static_cast<std::size_t>(part.end),
                                          static_cast<std::int32_t>(scene.surfaces.properties.size()));
  scene.surfaces.properties.push_back(properties);
  return part;
}

class Dice {
 public:
  explicit Dice(std::uint32_t seed) : engine_(seed) {}
  double between(double lower, double upper) { return lower + (upper - lower) * (double(engine_()) * 0x1p-32); }
  bool one_in(std::uint32_t n) { return engine_() % n == 0; }

 private:
  std::mt19937 engine_;
};

/// Crumpled layers over a body, thrown together: pairs of all kinds end near each other. Every part is a surface.
StepScene random_stack(std::uint32_t seed) {
  Dice dice(seed);
  StepScene scene;
  scene.options.max_impulse_rounds = static_cast<std::int32_t>(dice.between(0, 8));
  const double gap_m = std::exp2(dice.between(-14, -8));
  const auto properties = [&] {
    ContactProperties p;
    p.tolerance_m = dice.one_in(4) ? 0 : gap_m * std::exp2(dice.between(-8, 1));
    p.thickness_m = gap_m * std::exp2(dice.between(-3, 2));
    p.friction_static = dice.one_in(3) ? 0 : dice.between(0, 1);
    p.friction_kinetic = p.friction_static * dice.between(0, 1);
    return p;
  };
  const int layers = dice.one_in(2) ? 2 : 3;
  for (int layer = 0; layer < layers; ++layer) {
    const StepScene::Part part = add(scene, properties(), make_sheet(4, 4, 0.1, 0.1),
                                     Vec3(dice.between(-0.01, 0.01), dice.between(-0.01, 0.01), gap_m * layer));
    for (VertexId v = part.begin; v < part.end; ++v) {
      for (int axis = 0; axis < 3; ++axis) scene.V_t0(v, axis) += 0.4 * gap_m * dice.between(-1, 1);
    }
  }
  add(scene, properties(), make_box(Vec3(0.06, 0.06, 0.02), 1), Vec3(0, 0, -0.01 - gap_m), 0);
  scene.V_candidate = scene.V_t0;
  for (Eigen::Index v = 0; v < scene.V_t0.rows(); ++v) {
    if (scene.body[static_cast<std::size_t>(v)] >= 0) continue;
    scene.V_candidate(v, 2) *= dice.between(-0.5, 1);
  }
  return scene;
}

using NamedPairs = std::set<std::pair<PairKind, std::array<std::int32_t, 2>>>;

/// The pairs of cloth that the exact checker finds nearer than `distance`; `keep` says which of them count.
template <class Keep>
NamedPairs exactly_near(const StepScene& scene, const Positions& x, double distance, Keep keep) {
  NamedPairs pairs;
  const auto topology = verify::make_topology({scene.triangles, scene.face_is_body}, scene.body.size());
  for (const verify::Violation& near : verify::near_pairs(topology, points_of(x), distance)) {
    const PairKind kind = near.event == verify::EventKind::kVf ? PairKind::kVf : PairKind::kEe;
    if (keep(kind, near.vertices)) pairs.insert({kind, near.features});
  }
  return pairs;
}

}  // namespace

TEST(ContactProperties, OfAPairAreTheMeanTheLargerAndTheGeometricMean) {
  const ContactProperties pair = combine({4e-3, 1e-6, 0.9, 0.4}, {1e-3, 2e-5, 0.4, 0.1});
  EXPECT_DOUBLE_EQ(pair.thickness_m, 2.5e-3);
  EXPECT_EQ(pair.tolerance_m, 2e-5);
  EXPECT_DOUBLE_EQ(pair.friction_static, 0.6);
  EXPECT_DOUBLE_EQ(pair.friction_kinetic, 0.2);
  EXPECT_EQ(combine({1e-3, 0, 5, 4}, {1e-3, 0, 0, 0}).friction_static, 0) << "nothing grips ice";
}

TEST(ContactProperties, CombineSymmetricallyStayInRangeAndKeepWhatIsEqual) {
  Dice dice(1);
  for (int n = 0; n < 10000; ++n) {
    const auto draw = [&] {
      const double friction = std::exp2(dice.between(-40, 4));
      return ContactProperties{std::exp2(dice.between(-40, 4)), std::exp2(dice.between(-40, 4)), friction,
                               dice.one_in(3) ? friction : std::nextafter(friction, 0.0)};
    };
    const ContactProperties a = draw(), b = draw(), pair = combine(a, b);
    ASSERT_EQ(pair, combine(b, a));
    ASSERT_TRUE(is_valid(pair));
    ASSERT_EQ(combine(a, a), a);
  }
}

TEST(ContactSurfaces, ThatDoNotFitTheMeshAreCalledInvalid) {
  const ContactProperties good;
  const auto error_with = [&](std::vector<ContactProperties> properties, std::vector<std::int32_t> surface_of_vertex) {
    StepScene scene;
    scene.add(make_sheet(2, 2, 0.1, 0.1), Vec3::Zero());
    scene.surfaces = {std::move(properties), std::move(surface_of_vertex)};
    const CollisionStepResult result = scene.step();
    EXPECT_EQ(result.report.status == StepStatus::kSafe, result.report.input_error == InputError::kNone);
    return result.report.input_error;
  };
  EXPECT_EQ(error_with({good, good}, {1, 1, 1, 1}), InputError::kNone);
  EXPECT_EQ(error_with({good}, {0, 0, 0}), InputError::kBadSurfaces);
  EXPECT_EQ(error_with({good}, {}), InputError::kBadSurfaces);
  EXPECT_EQ(error_with({}, {0, 0, 0, 0}), InputError::kBadSurfaces);
  EXPECT_EQ(error_with({good}, {0, 0, 0, 1}), InputError::kBadSurfaces);
  EXPECT_EQ(error_with({good}, {0, -1, 0, 0}), InputError::kBadSurfaces);
  EXPECT_EQ(error_with({good, good}, {0, 0, 0, 1}), InputError::kBadSurfaces) << "a face of two surfaces";
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const ContactProperties& bad :
       {ContactProperties{-1, 0, 0, 0}, ContactProperties{1, nan, 0, 0}, ContactProperties{1, 0, 0.1, 0.2},
        ContactProperties{1, 0, std::numeric_limits<double>::infinity(), 0}}) {
    EXPECT_EQ(error_with({bad}, {0, 0, 0, 0}), InputError::kBadOption);
  }
}

TEST(ContactSurfaces, ThatAreAllAlikeGiveTheBitsOfTheOptions) {
  std::int64_t proximities = 0;
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    StepScene scene = random_stack(seed);
    const ContactProperties same = scene.surfaces.properties.front();
    for (ContactProperties& p : scene.surfaces.properties) p = same;
    const CollisionStepResult by_surfaces = scene.step();
    scene.surfaces = {};
    scene.options.thickness_m = same.thickness_m;
    scene.options.tolerance_m = same.tolerance_m;
    scene.options.friction_static = same.friction_static;
    scene.options.friction_kinetic = same.friction_kinetic;
    const CollisionStepResult by_options = scene.step();
    ASSERT_EQ(by_surfaces.x, by_options.x) << seed;
    ASSERT_EQ(by_surfaces.velocity, by_options.velocity) << seed;
    ASSERT_EQ(by_surfaces.report.proximities, by_options.report.proximities) << seed;
    proximities += by_options.report.proximities;
  }
  EXPECT_GT(proximities, 1000) << "too few to tell";
}

// S1 and S2 against the exact checker: what ends nearer than the tolerance of its own pair is named, and nothing else.
TEST(ContactSurfaces, EveryPairIsHeldToItsOwnTolerance) {
  std::size_t named_in_all = 0, near_for_others = 0;
  for (std::uint32_t seed = 0; seed < 120; ++seed) {
    const StepScene scene = random_stack(seed);
    const CollisionStepResult result = scene.step();
    ASSERT_EQ(exact_defect(scene, result), "") << seed;
    NamedPairs named;
    for (const Collision& pair : result.report.below_tolerance) {
      if (pair.kind != PairKind::kSelf) named.insert({pair.kind, {pair.first, pair.second}});
    }
    named_in_all += named.size();
    std::set<double> tolerances;
    for (const ContactProperties& p : scene.surfaces.properties) tolerances.insert(p.tolerance_m);
    NamedPairs near, nearly;
    for (const double tolerance : tolerances) {
      const auto is_of_tolerance = [&](PairKind kind, const std::array<std::int32_t, 6>& v) {
        const auto& a = scene.surfaces.properties[static_cast<std::size_t>(surface_of(scene, v[0]))];
        const auto& b =
            scene.surfaces.properties[static_cast<std::size_t>(surface_of(scene, v[kind == PairKind::kVf ? 1 : 2]))];
        return std::max(a.tolerance_m, b.tolerance_m) == tolerance;
      };
      if (tolerance == 0) continue;  // no touch is a distance above zero, which exact_defect() has found
      near.merge(exactly_near(scene, result.x, tolerance, is_of_tolerance));
      nearly.merge(exactly_near(scene, result.x, tolerance * (1 + 1e-9), is_of_tolerance));
    }
    ASSERT_TRUE(std::ranges::includes(named, near)) << seed << ": a near pair is not named";
    ASSERT_TRUE(std::ranges::includes(nearly, named)) << seed << ": a pair beyond its tolerance is named";
    const auto any = [](PairKind, const auto&) { return true; };
    near_for_others += exactly_near(scene, result.x, *tolerances.rbegin(), any).size() - near.size();
  }
  EXPECT_GT(named_in_all, 100U);
  EXPECT_GT(near_for_others, 1000U) << "one tolerance for all would name these";
}

TEST(ContactSurfaces, APairRepelsBelowTheMeanOfItsThicknesses) {
  // 3 mm above a body of 2 mm: cloth of 1 mm has 1.5 mm together with it, cloth of 6 mm has 4.
  const auto sinks_by = [](double thickness_m) {
    StepScene scene;
    const StepScene::Part cloth =
        add(scene, {.thickness_m = thickness_m}, make_sheet(3, 3, 0.1, 0.1), Vec3(0.003, 0.002, 3e-3));
    add(scene, {.thickness_m = 2e-3}, make_sheet(2, 2, 1, 1), Vec3::Zero(), 0);
    scene.push(cloth, Vec3(0, 0, -1e-4));
    return scene.V_t0(0, 2) - scene.step().x(0, 2);
  };
  EXPECT_NEAR(sinks_by(1e-3), 1e-4, 1e-12);
  EXPECT_NEAR(sinks_by(3.9e-3), 0.5e-4, 1e-12) << "to 2.95 mm together";
  EXPECT_NEAR(sinks_by(4.1e-3), 0, 1e-12) << "3.05 mm together";
  EXPECT_NEAR(sinks_by(6e-3), 0, 1e-12);
}

// 20 um apart where 100 are asked for: by what the surfaces have, not the options.
TEST(ContactSurfaces, APairIsPushedToItsOwnTolerance) {
  for (const bool by_zones : {false, true}) {
    StepScene scene;
    scene.options.repulsion = false;
    scene.options.tolerance_m = by_zones ? 1e-2 : 1e-6;
    if (by_zones) scene.options.max_impulse_rounds = 0;
    add(scene, {.tolerance_m = 1e-4}, triangle(0.1), Vec3::Zero());
    const StepScene::Part upper = add(scene, {.tolerance_m = 1e-5}, triangle(0.01), Vec3(0, 0, 1e-3));
    scene.push(upper, Vec3(0, 0, 2e-5 - 1e-3));
    const CollisionStepResult result = scene.step();
    EXPECT_EQ(exact_defect(scene, result), "");
    EXPECT_TRUE(result.report.below_tolerance.empty()) << by_zones;
    EXPECT_GE(lowest(result.x, upper) - highest(result.x, {0, 3}), 1e-4) << by_zones;
  }
}

// 20 um apart: within the tolerance of a surface elsewhere, by which the pair is asked first, and beyond its own.
TEST(ContactSurfaces, QueriesForTheOwnToleranceAreCounted) {
  const auto intervals_with = [](double of_pair_m) {
    StepScene scene;
    scene.options.max_impulse_rounds = scene.options.max_zone_rounds = 0;
    add(scene, {.tolerance_m = of_pair_m}, triangle(0.1), Vec3::Zero());
    add(scene, {.tolerance_m = of_pair_m}, triangle(0.01), Vec3(0, 0, 2e-5));
    add(scene, {.tolerance_m = 1e-4}, triangle(0.1), Vec3(5, 0, 0));
    const CollisionStepResult result = scene.step();
    EXPECT_EQ(result.report.below_tolerance.empty(), of_pair_m < 2e-5);
    return result.report.certificate.intervals;
  };
  EXPECT_GT(intervals_with(1e-5), intervals_with(1e-4)) << "asked twice";
}

// Limits what moves to a quarter of the distance, looked for within the largest thickness of all.
TEST(ContactSurfaces, TheFailSafeLooksAsFarAsTheThickestSurface) {
  StepScene scene;
  scene.options = {.thickness_m = 1e-5, .repulsion = false, .max_impulse_rounds = 0, .max_zone_rounds = 0};
  add(scene, {.thickness_m = 1e-3}, triangle(0.1), Vec3::Zero());
  const StepScene::Part upper = add(scene, {.thickness_m = 8e-3}, triangle(0.01), Vec3(0, 0, 0.01));
  scene.push(upper, Vec3(0, 0, -0.02));
  const CollisionStepResult result = scene.step();
  EXPECT_EQ(exact_defect(scene, result), "");
  EXPECT_NEAR(lowest(result.x, upper), 0.01 - 8e-3 / 4, 1e-12);
}

TEST(ContactSurfaces, FrictionIsThatOfThePair) {
  // Pressed by 1e-4 m and dragged by 1e-3: kinetic friction takes coefficient times 1e-4 off.
  const auto dragged_by = [](double of_cloth, double of_body) {
    StepScene scene;
    const StepScene::Part cloth = add(scene, {.friction_static = of_cloth, .friction_kinetic = of_cloth},
                                      make_sheet(3, 3, 0.1, 0.1), Vec3(0.003, 0.002, 5e-4));
    add(scene, {.friction_static = of_body, .friction_kinetic = of_body}, make_sheet(2, 2, 1, 1), Vec3::Zero(), 0);
    scene.push(cloth, Vec3(1e-3, 0, -1e-4));
    return scene.step().x(4, 0) - scene.V_t0(4, 0);
  };
  EXPECT_NEAR(dragged_by(0.4, 0.4), 1e-3 - 0.4e-4, 1e-9);
  EXPECT_NEAR(dragged_by(0.9, 0.4), 1e-3 - 0.6e-4, 1e-9);
  EXPECT_NEAR(dragged_by(0.9, 0), 1e-3, 1e-9);
}

TEST(RestPairs, AreAllThatAreNearerAtRestThanTheThickness) {
  StepScene scene;
  scene.add(make_sheet(6, 5, 0.5, 0.4), Vec3::Zero());
  const Mesh mesh = scene.mesh();
  EXPECT_TRUE(find_rest_pairs(mesh, scene.V_t0, 0.07).empty()) << "squares of 0.1 m: 0.0707 across a face";
  BoxHierarchy hierarchy(mesh);
  for (const double thickness_m : {0.08, 0.15, 0.32}) {
    std::vector<RestPair> pairs = find_rest_pairs(mesh, scene.V_t0, thickness_m);
    // Of a face's own, the corner with the right angle is nearest to the edge before it; 0.1 m are from the others.
    const auto of_faces = std::erase_if(pairs, [](const RestPair& pair) { return pair.kind == PairKind::kSelf; });
    EXPECT_EQ(of_faces, mesh.faces.size() * (thickness_m < 0.1 ? 1 : 3));
    std::vector<RestPair> expected;
    for (const PairProximity& pair : find_proximities(mesh, hierarchy, scene.V_t0, 1)) {
      if (!(pair.proximity.distance < thickness_m)) continue;
      expected.push_back({pair.kind, pair.first, pair.second, pair.proximity.distance});
    }
    EXPECT_GT(pairs.size(), 30U);
    EXPECT_EQ(pairs, expected);
  }
  scene.V_t0(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(find_rest_pairs(mesh, scene.V_t0, 1).empty());
}

TEST(RestPairs, ThatDoNotFitTheMeshAreCalledInvalid) {
  const auto error_with = [](const RestPair& pair) {
    StepScene scene;
    scene.add(make_sheet(3, 2, 0.1, 0.1), Vec3::Zero());  // 6 vertices, 4 faces, 9 edges
    scene.surfaces.rest_pairs = {{PairKind::kVf, 0, 3, 0.05}, pair};
    const CollisionStepResult result = scene.step();
    EXPECT_EQ(result.report.status == StepStatus::kSafe, result.report.input_error == InputError::kNone);
    return result.report.input_error;
  };
  EXPECT_EQ(error_with({PairKind::kVf, 5, 0, 0}), InputError::kNone);
  EXPECT_EQ(error_with({PairKind::kEe, 0, 8, 0.05}), InputError::kNone);
  EXPECT_EQ(error_with({PairKind::kEe, 7, 8, 0.05}), InputError::kBadSurfaces) << "they share a vertex";
  EXPECT_EQ(error_with({PairKind::kVf, 0, 0, 0.05}), InputError::kBadSurfaces) << "a corner of the face";
  EXPECT_EQ(error_with({PairKind::kVf, 0, 3, 0.06}), InputError::kNone) << "named twice";
  EXPECT_EQ(error_with({PairKind::kVf, 6, 0, 0.05}), InputError::kBadSurfaces);
  EXPECT_EQ(error_with({PairKind::kVf, 5, 4, 0.05}), InputError::kBadSurfaces);
  EXPECT_EQ(error_with({PairKind::kVf, -1, 0, 0.05}), InputError::kBadSurfaces);
  EXPECT_EQ(error_with({PairKind::kVf, 0, -1, 0.05}), InputError::kBadSurfaces);
  EXPECT_EQ(error_with({PairKind::kEe, 0, 9, 0.05}), InputError::kBadSurfaces);
  EXPECT_EQ(error_with({PairKind::kEe, 8, 7, 0.05}), InputError::kBadSurfaces) << "the lower number is first";
  EXPECT_EQ(error_with({PairKind::kSelf, 0, 0, 0.05}), InputError::kNone);
  EXPECT_EQ(error_with({PairKind::kSelf, 0, 3, 0.05}), InputError::kBadSurfaces) << "no corner of the face";
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {-1e-9, inf, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(error_with({PairKind::kVf, 0, 3, bad}), InputError::kBadOption);
  }
}

TEST(RestPairs, ThatAreNamedTwiceAreAsThickAsTheNearer) {
  StepScene scene;
  scene.options.thickness_m = 1;
  scene.add(make_sheet(3, 2, 0.1, 0.1), Vec3::Zero());
  const Mesh mesh = scene.mesh();
  for (const std::pair<double, double>& named : {std::pair(0.05, 0.06), std::pair(0.06, 0.05)}) {
    const std::vector<RestPair> pairs{{PairKind::kVf, 0, 3, named.first}, {PairKind::kVf, 0, 3, named.second}};
    const ContactTable table(mesh, scene.options, {{}, {}, pairs});
    EXPECT_EQ(table.of(PairKind::kVf, 0, 3).thickness_m, 0.05);
  }
}

TEST(RestPairs, AreAsThickAsTheyAreFarApartAtRestAndOthersAsTheirSurfaces) {
  StepScene scene = random_stack(1);
  const Mesh mesh = scene.mesh();
  const ContactTable without(mesh, scene.options, scene.surfaces);
  EXPECT_FALSE(without.is_uniform());
  EXPECT_TRUE(ContactTable(mesh, scene.options, {}).is_uniform());
  const auto count_of_faces = std::ssize(mesh.faces), count_of_edges = std::ssize(mesh.edges);
  const auto near = [&](PairKind kind, std::int32_t first, std::int32_t second) {
    const auto v = pair_vertices(mesh, kind, first, second);
    const std::size_t other = kind == PairKind::kVf ? 1 : 2;
    const bool apart =
        std::find_first_of(v.begin(), v.begin() + other, v.begin() + other, v.end()) == v.begin() + other;
    return apart && (first * 7 + second) % 5 == 0;
  };
  const auto distance_m = [](std::int32_t first, std::int32_t second) { return 1e-4 * (1 + (first + second) % 40); };
  for (VertexId v = 0; v < mesh.vertex_count; ++v) {
    for (FaceId f = 0; f < count_of_faces; ++f) {
      if (near(PairKind::kVf, v, f)) scene.surfaces.rest_pairs.push_back({PairKind::kVf, v, f, distance_m(v, f)});
    }
  }
  for (EdgeId a = 0; a < count_of_edges; ++a) {
    for (EdgeId b = a + 1; b < count_of_edges; ++b) {
      if (near(PairKind::kEe, a, b)) scene.surfaces.rest_pairs.push_back({PairKind::kEe, a, b, distance_m(a, b)});
    }
  }
  std::ranges::shuffle(scene.surfaces.rest_pairs, std::mt19937(7));
  const ContactTable with(mesh, scene.options, scene.surfaces);
  EXPECT_EQ(with.thickness_upper(), without.thickness_upper());
  const auto check = [&](PairKind kind, std::int32_t first, std::int32_t second) {
    ContactProperties expected = without.of(kind, first, second);
    if (near(kind, first, second)) {
      expected.is_of_rest = distance_m(first, second) < expected.thickness_m;
      expected.thickness_m = std::min(expected.thickness_m, distance_m(first, second));
      expected.tolerance_m = std::min(expected.tolerance_m, distance_m(first, second) / 2);
    }
    ASSERT_EQ(with.of(kind, first, second), expected);
  };
  for (VertexId v = 0; v < mesh.vertex_count; ++v) {
    for (FaceId f = 0; f < count_of_faces; ++f) check(PairKind::kVf, v, f);
  }
  for (EdgeId a = 0; a < count_of_edges; ++a) {
    for (EdgeId b = a + 1; b < count_of_edges; ++b) check(PairKind::kEe, a, b);
  }
  const FaceId own_face = mesh.vertex_owner[0];
  EXPECT_EQ(with.of(PairKind::kSelf, 0, own_face), without.of(PairKind::kSelf, 0, own_face));
}

TEST(RestPairs, KeepASheetThatIsThickerThanItsEdgesAsItIs) {
  StepScene scene;
  scene.add(make_sheet(5, 5, 0.04, 0.04), Vec3::Zero());
  scene.options.thickness_m = 0.025;
  scene.options.repulsion_stiffness_n_m = 1e3;
  const auto moves_by = [&] { return (scene.step().x - scene.V_t0).cwiseAbs().maxCoeff(); };
  EXPECT_GT(moves_by(), 1e-3) << "inflates by a tenth of the overlap a step";
  scene.surfaces.rest_pairs = find_rest_pairs(scene.mesh(), scene.V_t0, scene.options.thickness_m);
  EXPECT_EQ(moves_by(), 0);

  // Pressed together, it is held at the distances at rest; another sheet is at the whole thickness.
  scene.V_candidate.col(0) *= 0.9;
  EXPECT_GT((scene.step().x - scene.V_candidate).cwiseAbs().maxCoeff(), 1e-3);
  const StepScene::Part upper = scene.add(make_sheet(2, 2, 0.01, 0.01), Vec3(0.002, 0.001, 0.026));
  scene.push(upper, Vec3(0, 0, -0.004));
  std::fill_n(scene.inverse_mass.begin(), 25, 0.0);
  EXPECT_NEAR(scene.step().x.bottomRows(4).col(2).mean(), 0.025, 5e-4);
}

}  // namespace selvage::sim::testbed
