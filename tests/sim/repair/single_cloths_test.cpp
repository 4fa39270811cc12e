// Single cloths that went through themselves, which near rings leave tangled: laid flat, or drawn back from far.
#include <cmath>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "tests/sim/repair/untangle_scene.h"

namespace selvage::sim::testbed {
namespace {

/// A strip in the plane of (along, up), by arc length: flat, then around a circle, then straight on.
struct Bend {
  double radius_m = 0.1, angle = 0;

  [[nodiscard]] Eigen::Vector2d at(double s) const {
    if (s <= 0) return {s, 0};
    const double a = std::min(s / radius_m, angle), rest = std::max(0.0, s - radius_m * angle);
    return {radius_m * std::sin(a) + rest * std::cos(a), radius_m * (1 - std::cos(a)) + rest * std::sin(a)};
  }
};

void shake(StepScene& scene, double by_m, std::uint32_t seed) {
  std::mt19937 engine(seed);
  for (Eigen::Index v = 0; v < scene.V_t0.rows(); ++v) {
    for (int axis = 0; axis < 3; ++axis) scene.V_t0(v, axis) += by_m * (double(engine()) * 0x1p-31 - 1);
  }
}

/// A sheet rolled up about one of its sides, so that its layers lie within one another or its end goes through them.
StepScene curled_sheet(std::int32_t nx, std::int32_t ny, const Bend& bend, std::uint32_t seed) {
  StepScene scene;
  const StepScene::Part sheet = scene.add(make_sheet(nx, ny, 1, 1), Vec3::Zero());
  for (VertexId v = sheet.begin; v < sheet.end; ++v) {
    const Eigen::Vector2d at = bend.at(scene.V_t0(v, 0) + 0.5);
    scene.V_t0.row(v) = Eigen::RowVector3d(at.x(), scene.V_t0(v, 1), at.y());
  }
  shake(scene, 2e-4, seed);
  return scene;
}

/// A sheet whose corner, that far along the diagonal, is bent until it goes through the rest.
StepScene bent_corner(std::int32_t nx, std::int32_t ny, double corner_m, const Bend& bend, std::uint32_t seed) {
  StepScene scene;
  const StepScene::Part sheet = scene.add(make_sheet(nx, ny, 1, 1), Vec3::Zero());
  const double begin = std::sqrt(0.5) - corner_m;
  for (VertexId v = sheet.begin; v < sheet.end; ++v) {
    const double x = scene.V_t0(v, 0), y = scene.V_t0(v, 1), across = (x - y) / std::numbers::sqrt2;
    const Eigen::Vector2d at = bend.at((x + y) / std::numbers::sqrt2 - begin);
    const double along = at.x() + begin;
    scene.V_t0.row(v) =
        Eigen::RowVector3d((along + across) / std::numbers::sqrt2, (along - across) / std::numbers::sqrt2, at.y());
  }
  shake(scene, 1e-4, seed);
  return scene;
}

struct Tangle {
  std::string name;
  StepScene scene;
};

/// Of 400 sheets curled at random and as many bent corners near rings left 23 as they were: of these, the smallest, and
/// those that took most rounds.
std::vector<Tangle> hard_tangles() {
  return {{"a small curl", curled_sheet(9, 8, {0.11, 7.8}, 1)},
          {"a narrow curl", curled_sheet(20, 14, {0.06, 9.2}, 1)},
          {"a wide curl", curled_sheet(14, 15, {0.11, 8.8}, 1)},
          {"a small corner", bent_corner(10, 12, 0.59, {0.04, 5}, 1)},
          {"a corner", bent_corner(20, 14, 0.59, {0.03, 4.2}, 1)}};
}

void expect_freed(const StepScene& scene, double largest_move_m) {
  ASSERT_NE(exact_defect(scene, scene.V_t0), "") << "the case is no tangle";
  const UntangleResult result = untangle_scene(scene, 3e-3);
  EXPECT_EQ(defect_of(scene, result), "");
  EXPECT_TRUE(result.report.remaining.empty()) << result.report.remaining.size() << " pairs remain";
  EXPECT_LE((result.x - scene.V_t0).rowwise().norm().maxCoeff(), largest_move_m);
}

}  // namespace

// Taken back from where they lay flat, a metre across, they come to within a fifth.
TEST(SingleCloths, AreLaidFlatWhereNothingHoldsThem) {
  for (const Tangle& tangle : hard_tangles()) {
    SCOPED_TRACE(tangle.name);
    expect_freed(tangle.scene, 0.25);
  }
}

TEST(SingleCloths, AreDrawnBackFromFarWhereOneVertexIsPinned) {
  std::vector<Tangle> tangles = hard_tangles();
  for (std::size_t n = 1; n < tangles.size(); ++n) {
    SCOPED_TRACE(tangles[n].name);
    tangles[n].scene.inverse_mass[0] = 0;
    expect_freed(tangles[n].scene, 0.8);
  }
}

TEST(SingleCloths, AreLaidFlatBesideOthers) {
  StepScene scene = curled_sheet(9, 8, {0.11, 7.8}, 1);
  const StepScene::Part wall = scene.add(make_sheet(5, 5, 3, 3), Vec3(0.05, 0, 0.3));
  const StepScene::Part other_wall = scene.add(make_sheet(5, 5, 3, 3), Vec3(0.05, 0, -0.03));
  for (VertexId v = wall.begin; v < other_wall.end; ++v) scene.inverse_mass[static_cast<std::size_t>(v)] = 0;
  expect_freed(scene, 1);
}

// Along a row of vertices, and between two, where faces have no area and border edges no length.
TEST(SingleCloths, ComeApartWhereTheyAreFoldedExactlyFlat) {
  for (const std::int32_t side : {5, 6}) {
    SCOPED_TRACE(side);
    StepScene scene;
    const StepScene::Part sheet = scene.add(make_sheet(side, side, 1, 1), Vec3::Zero());
    for (VertexId v = sheet.begin; v < sheet.end; ++v) scene.V_t0(v, 0) = std::abs(scene.V_t0(v, 0));
    expect_freed(scene, 1);
  }
}

// By a judge for whom each try but those that are flat, or nearly so, is better by a single pair: tries to draw cloth
// back would use up all rounds.
TEST(SingleCloths, AreLaidFlatBeforeTheRoundsEnd) {
  StepScene scene;
  scene.add(make_sheet(8, 8, 1, 1), Vec3::Zero());
  std::vector<FacePair> pairs;  // of faces away from two opposite corners, which tell what is flat
  for (FaceId f = 14; f < 78; ++f) {
    for (FaceId g = f + 1; g < 78; ++g) pairs.push_back({f, g});
  }
  bool was_flat = false;
  const FindIntersections judge = [&](const Positions& x) {
    was_flat = was_flat || (x.row(0) - x.row(63)).norm() < 1.3;
    if (was_flat) return std::vector<FacePair>{};
    pairs.pop_back();
    return pairs;
  };
  const UntangleResult result = untangle(scene.mesh(), scene.V_t0, scene.bodies(), {}, judge);
  EXPECT_TRUE(result.report.remaining.empty());
  EXPECT_GT(result.report.rounds, kMaxUntangleRounds / 2) << "the judge asks for something";
}

TEST(SingleCloths, ComeOutWithTheSameBitsEveryTime) {
  const StepScene scene = curled_sheet(9, 8, {0.11, 7.8}, 1);
  EXPECT_EQ(untangle_scene(scene, 3e-3).x, untangle_scene(scene, 3e-3).x);
}

}  // namespace selvage::sim::testbed
