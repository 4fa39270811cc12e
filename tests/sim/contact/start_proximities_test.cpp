// Which pairs repel: those of all near pairs that approach and are local, and no others.
#include "sim/contact/start_proximities.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "kernel/collisions.h"
#include "sim/contact/contact_reach.h"
#include "sim/contact/local_proximities.h"
#include "sim/response/repulsion.h"
#include "tests/property.h"
#include "tests/sim/mechanics.h"
#include "tests/sim/step_scene.h"

namespace selvage::sim::testbed {
namespace {

using Name = std::tuple<PairKind, std::int32_t, std::int32_t>;
Name name_of(const PairProximity& pair) { return {pair.kind, pair.first, pair.second}; }

/// Two sheets, one over the other, crumpled; some coordinates on a lattice, so that distances and directions tie.
StepScene random_layers() {
  StepScene scene;
  const auto side = *rc::gen::inRange(3, 6);
  const double gap = number_between(0.01, 0.03);
  scene.add(make_sheet(side, side, 0.1, 0.1), Vec3::Zero());
  scene.add(make_sheet(4, 4, 0.1, 0.1), Vec3(number_between(0, 0.03), number_between(0, 0.03), gap));
  const double crumple = *rc::gen::element(0.0, 0.005, 0.02), motion = *rc::gen::element(0.002, 0.02);
  for (Eigen::Index i = 0; i < scene.V_t0.size(); ++i) {
    scene.V_t0.data()[i] += number_between(-crumple, crumple);
    scene.V_candidate.data()[i] = scene.V_t0.data()[i] + number_between(-motion, motion);
  }
  scene.options.thickness_m = 0.015;
  return scene;
}

/// A sheet that comes down on another.
struct TwoSheets : StepScene {
  Part upper;
  TwoSheets() {
    add(make_sheet(5, 5, 0.1, 0.1), Vec3::Zero());
    upper = add(make_sheet(4, 4, 0.08, 0.08), Vec3(0.01, 0.01, 0.012));
    push(upper, Vec3(0, 0, -0.01));
    options.thickness_m = 0.01;
  }
  [[nodiscard]] Positions with_upper_lifted(double height_m) const {
    Positions V = V_t0;
    V.col(2).segment(upper.begin, upper.end - upper.begin).array() += height_m;
    return V;
  }
};

struct NearTwoSheets {
  TwoSheets scene;
  Mesh mesh = scene.mesh();
  ContactTable contacts{mesh, scene.options, {}};
  BoxHierarchy hierarchy{mesh};
  VertexFaces faces{mesh};
  StartProximities near{mesh, contacts, faces};

  void start(const Positions& V_t0) {
    near.start(hierarchy, V_t0, std::vector<std::uint8_t>(scene.inverse_mass.size(), 1));
  }
};

/// How much nearer than its thickness the pair comes, by the kernel's answer.
double approach(const PairProximity& pair, const StepScene& scene, const Positions& V_t1) {
  double moved = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const bool first = k < (pair.kind == PairKind::kVf ? 1 : 2);
    const Vec3 d = V_t1.row(pair.vertices[k]) - scene.V_t0.row(pair.vertices[k]);
    moved += (first ? 1 : -1) * pair.proximity.weights[k] * d.dot(pair.proximity.normal);
  }
  return scene.options.thickness_m - pair.proximity.distance - moved;
}

/// Edges whose nearest points are anywhere, and features that touch, have many answers.
bool is_unsure(const PairProximity& pair, const StepScene& scene) {
  if (!(pair.proximity.distance > 1e-9)) return true;
  if (pair.kind == PairKind::kVf) return false;
  const auto edge = [&](std::size_t k) -> Vec3 {
    return (scene.V_t0.row(pair.vertices[k + 1]) - scene.V_t0.row(pair.vertices[k])).normalized();
  };
  return edge(0).cross(edge(2)).norm() < 1e-5;
}

}  // namespace

TEST(StartProximities, PropAreAllThatApproachAndAreLocalAndOnceEach) {
  selvage::testing::check_property(200, 32, [] {
    StepScene scene = random_layers();
    const Mesh mesh = scene.mesh();
    const ContactTable contacts(mesh, scene.options, {});
    const std::vector<std::uint8_t> surface(scene.inverse_mass.size(), 1);
    BoxHierarchy hierarchy(mesh);
    const VertexFaces faces(mesh);
    StartProximities near(mesh, contacts, faces);
    const double thickness_m = scene.options.thickness_m;
    const std::vector<PairProximity> all = find_proximities(mesh, hierarchy, scene.V_t0, kContactReach * thickness_m);
    const std::vector<PairProximity> local = local_proximities(mesh, faces, scene.V_t0, all, thickness_m);

    near.start(hierarchy, scene.V_t0, surface);
    std::set<Name> known;
    Positions V_t1 = scene.V_candidate;
    for (int round = 0; round < 2; ++round) {
      std::set<Name> found;
      for (const PairProximity& pair : near.find(V_t1)) {
        RC_ASSERT(found.insert(name_of(pair)).second);
        RC_ASSERT(!known.contains(name_of(pair)));
        RC_ASSERT(approach(pair, scene, V_t1) > -1e-9 || is_unsure(pair, scene));
      }
      for (const PairProximity& pair : local) {
        if (!(approach(pair, scene, V_t1) > 1e-9) || known.contains(name_of(pair))) continue;
        RC_ASSERT(found.contains(name_of(pair)) || is_unsure(pair, scene));
      }
      for (const Name& name : found) {
        RC_ASSERT(std::ranges::any_of(local, [&](const PairProximity& pair) { return name_of(pair) == name; }));
      }
      known.merge(found);
      V_t1 = scene.V_t0 + 2 * (V_t1 - scene.V_t0);  // what else comes near
    }
  });
}

// Whatever was asked before of the same start: other motions, other tries, each with its own pairs to compare with.
TEST(StartProximities, PropDoNotDependOnWhatWasAskedBefore) {
  std::int64_t answers = 0;
  selvage::testing::check_property(200, 33, [&] {
    const StepScene scene = random_layers();
    const Mesh mesh = scene.mesh();
    const ContactTable contacts(mesh, scene.options, {});
    const std::vector<std::uint8_t> surface(scene.inverse_mass.size(), 1);
    BoxHierarchy hierarchy(mesh);
    const VertexFaces faces(mesh);
    StartProximities near(mesh, contacts, faces);
    for (int n = 0; n < 4; ++n) {
      const Positions motion = scene.V_candidate - scene.V_t0;
      const Positions V_t0 = scene.V_t0 + *rc::gen::element(0.0, 0.0, 0.5) * motion;  // often as before
      const Positions V_t1 = V_t0 + number_between(-1, 1) * motion;
      StartProximities fresh(mesh, contacts, faces);
      fresh.start(hierarchy, V_t0, surface);
      near.start(hierarchy, V_t0, surface);
      std::vector<Name> found, expected;
      for (const PairProximity& pair : near.find(V_t1)) found.push_back(name_of(pair));
      for (const PairProximity& pair : fresh.find(V_t1)) expected.push_back(name_of(pair));
      RC_ASSERT(found == expected);
      RC_ASSERT(near.count() == fresh.count());
      answers += std::ssize(found);
    }
  });
  EXPECT_GT(answers, 1000);
}

TEST(StartProximities, OfClothThatRestsOnClothFindWhatAFallOfOneWouldPress) {
  constexpr double kThickness = 0.01;
  const auto found = [&](double gap_m, const Vec3& fall) {
    StepScene scene;
    scene.add(make_sheet(5, 5, 0.1, 0.1), Vec3::Zero());
    scene.add(make_sheet(4, 4, 0.08, 0.08), Vec3(0.01, 0.01, gap_m));
    scene.options.thickness_m = kThickness;
    const Mesh mesh = scene.mesh();
    const ContactTable contacts(mesh, scene.options, {});
    BoxHierarchy hierarchy(mesh);
    const VertexFaces faces(mesh);
    StartProximities near(mesh, contacts, faces);
    near.start(hierarchy, scene.V_t0, std::vector<std::uint8_t>(scene.inverse_mass.size(), 1));
    const Positions both_fallen = scene.V_t0.rowwise() + 2 * fall.transpose();
    return near.find(both_fallen, fall).size();
  };
  EXPECT_GT(found(1.01 * kThickness, {0, 0, -0.02 * kThickness}), 10U);
  EXPECT_GT(found(1.01 * kThickness, {0, 0, 0.02 * kThickness}), 10U) << "whichever of the two stands still";
  EXPECT_EQ(found(1.03 * kThickness, {0, 0, -0.02 * kThickness}), 0U) << "farther apart than they fall";
  EXPECT_EQ(found(1.01 * kThickness, {-0.02 * kThickness, 0, 0}), 0U) << "across";
  EXPECT_EQ(found(1.2 * kThickness, {0, 0, -kThickness}), 0U) << "no rest";
}

TEST(StartProximities, OfThoseThatPressFindWhatIsNearWhateverTheMotion) {
  NearTwoSheets near_sheets;
  const TwoSheets& scene = near_sheets.scene;
  StartProximities& near = near_sheets.near;
  near_sheets.start(scene.V_t0);
  const std::vector<PairProximity> approaching = near.find(scene.V_candidate);
  Candidates pressed;
  for (const PairProximity& pair : approaching) {
    if (pair.kind == PairKind::kVf) pressed.vf.push_back({pair.first, pair.second});
    if (pair.kind == PairKind::kEe) pressed.ee.push_back({pair.first, pair.second});
  }
  ASSERT_GT(approaching.size(), 10U);
  const Positions apart = 2 * scene.V_t0 - scene.V_candidate;
  near_sheets.start(scene.V_t0);
  EXPECT_TRUE(near.find(apart).empty());
  std::vector<Name> found, expected;
  for (const PairProximity& pair : near.find(apart, Vec3::Zero(), pressed)) found.push_back(name_of(pair));
  for (const PairProximity& pair : approaching) expected.push_back(name_of(pair));
  EXPECT_EQ(found, expected);
  EXPECT_TRUE(near.find(apart, Vec3::Zero(), pressed).empty()) << "once each";
  const Positions lifted = scene.with_upper_lifted(0.1);
  near_sheets.start(lifted);
  EXPECT_TRUE(near.find(lifted, Vec3::Zero(), pressed).empty()) << "not near";
}

TEST(StartProximities, ForgetTheLastStepAndOnlyThat) {
  NearTwoSheets near_sheets;
  const TwoSheets& scene = near_sheets.scene;
  StartProximities& near = near_sheets.near;
  near_sheets.start(scene.V_t0);
  const std::size_t count = near.find(scene.V_candidate).size();
  EXPECT_GT(count, 10U);
  EXPECT_TRUE(near.find(scene.V_candidate).empty());
  near_sheets.start(scene.V_t0);  // another try of the same step
  EXPECT_EQ(near.find(scene.V_candidate).size(), count);
  EXPECT_TRUE(near.find(scene.V_t0).empty());
  const Positions lifted = scene.with_upper_lifted(0.1);
  near_sheets.start(lifted);
  EXPECT_TRUE(near.find(lifted + (scene.V_candidate - scene.V_t0)).empty());
}

TEST(StartProximities, AreOfTheSurfaceThatIsFlagged) {
  const TwoSheets scene;
  const Mesh mesh = scene.mesh();
  const ContactTable contacts(mesh, scene.options, {});
  const std::vector<std::uint8_t> all(scene.inverse_mass.size(), 1), none(scene.inverse_mass.size(), 0);
  BoxHierarchy hierarchy(mesh);
  const VertexFaces faces(mesh);
  StartProximities near(mesh, contacts, faces);
  for (int time = 0; time < 2; ++time) {
    near.start(hierarchy, scene.V_t0, all);
    EXPECT_GT(near.find(scene.V_candidate).size(), 10U);
    near.start(hierarchy, scene.V_t0, none);
    EXPECT_TRUE(near.find(scene.V_candidate).empty());
  }
}

}  // namespace selvage::sim::testbed
