// S1 to S4 as properties: whatever the candidates, the exact checker finds nothing after any step.
#include <random>

#include "tests/property.h"
#include "tests/sim/mechanics.h"
#include "tests/sim/step_scene.h"

namespace selvage::sim::testbed {
namespace {

using selvage::testing::check_property;

class Noise {
 public:
  explicit Noise(std::uint64_t seed) : engine_(seed) {}
  double operator()() { return unit_(engine_); }  ///< in [-1, 1]

 private:
  std::mt19937_64 engine_;
  std::uniform_real_distribution<double> unit_{-1, 1};
};

double magnitude(double exponent_from, double exponent_to) {
  return std::exp2(number_between(exponent_from, exponent_to));
}

/// Layers of cloth 2^-16 to 2^-7 m apart, each crumpled by less than half the gap, with unequal masses; sometimes a
/// pin.
void add_layers(StepScene& scene, int layers, Noise& noise) {
  const double gap_m = magnitude(-16, -7);
  for (int layer = 0; layer < layers; ++layer) {
    const auto part = scene.add(make_sheet(integer_in(2, 5), integer_in(2, 5), 0.1, 0.1),
                                Vec3(0.01 * noise(), 0.01 * noise(), gap_m * layer));
    for (VertexId v = part.begin; v < part.end; ++v) {
      for (int axis = 0; axis < 3; ++axis) scene.V_t0(v, axis) += 0.45 * gap_m * noise();
      scene.inverse_mass[static_cast<std::size_t>(v)] = std::exp2(4 * noise());
    }
    if (integer_in(0, 6) == 0) scene.inverse_mass[static_cast<std::size_t>(part.begin)] = 0;
  }
}

/// How candidates are made: every kind breaks layers in its own way.
enum class Attack { kNone, kNoise, kSwapLayers, kCollapse, kExplode, kFold, kShear, kFar, kCount };

void attack(StepScene& scene, Attack kind, Noise& noise) {
  const double size_m = magnitude(-16, 4);
  const Vec3 target(0.05 * noise(), 0.05 * noise(), 0.01 * noise());
  const double far = magnitude(0, 990);
  const auto rows = scene.V_t0.rows();
  scene.V_candidate = scene.V_t0;
  for (Eigen::Index v = 0; v < rows; ++v) {
    if (scene.body[static_cast<std::size_t>(v)] >= 0) continue;
    auto x = scene.V_candidate.row(v);
    switch (kind) {
      case Attack::kNoise:
        x += size_m * Eigen::RowVector3d(noise(), noise(), noise());
        break;
      case Attack::kSwapLayers:
        x.z() = -x.z();
        break;
      case Attack::kCollapse:
        x = target.transpose();
        break;
      case Attack::kExplode:
        x *= 1 + size_m;
        break;
      case Attack::kFold:
        if (x.x() > 0) x.x() = -x.x();
        break;
      case Attack::kShear:
        x.x() += (v < rows / 2 ? size_m : -size_m);
        x.z() += (v < rows / 2 ? size_m : -size_m);
        break;
      case Attack::kFar:
        x = far * Eigen::RowVector3d(noise(), noise(), noise());
        break;
      case Attack::kNone:
      case Attack::kCount:
        break;
    }
  }
}

void random_options(StepScene& scene) {
  scene.options.max_impulse_rounds = integer_in(0, 3) == 0 ? 0 : integer_in(0, 11);
  scene.options.max_zone_rounds = integer_in(0, 3) == 0 ? 0 : integer_in(0, 21);
  scene.options.repulsion = integer_in(0, 3) != 0;
  scene.options.repulsion_stiffness_n_m = integer_in(0, 2) == 0 ? 0 : magnitude(0, 20);
  scene.options.friction_static = integer_in(0, 2) == 0 ? 0 : number_between(0, 1);
  scene.options.friction_kinetic = scene.options.friction_static * number_between(0, 1);
  scene.options.tolerance_m = integer_in(0, 4) == 0 ? 0 : 1e-6;
  scene.options.thickness_m = magnitude(-16, -6);
  scene.policy = integer_in(0, 2) == 0 ? SqueezePolicy::kStop : SqueezePolicy::kYield;
}

Attack random_attack() { return static_cast<Attack>(integer_in(0, static_cast<int>(Attack::kCount))); }

/// Steps a few times with new attacks; every result must be free of touch, exactly.
void step_and_check(StepScene& scene, Noise& noise, int steps) {
  for (int step = 0; step < steps; ++step) {
    attack(scene, random_attack(), noise);
    for (std::size_t v = 0; v < scene.body.size(); ++v) {
      if (scene.body[v] == 0) scene.V_candidate.row(static_cast<Eigen::Index>(v)).z() += 1e-3 * step;
      if (scene.body[v] == 1) scene.V_candidate.row(static_cast<Eigen::Index>(v)).z() -= 1e-2;
    }
    if (scene.options.precision == Precision::kFloat32) {
      scene.V_candidate = scene.V_candidate.unaryExpr([](double x) {
        constexpr double kMaxFloat = static_cast<double>(std::numeric_limits<float>::max());
        return static_cast<double>(static_cast<float>(std::clamp(x, -kMaxFloat, kMaxFloat)));
      });
    }
    const CollisionStepResult result = scene.step();
    if (result.report.status == StepStatus::kStopped) {
      RC_ASSERT(scene.policy == SqueezePolicy::kStop && result.report.witness.has_value());
      RC_ASSERT(result.x == scene.V_t0);
      return;
    }
    RC_ASSERT(exact_defect(scene, result) == "");
    scene.V_t0 = result.x;
  }
}

Vec3 linear_momentum(const StepScene& scene, const Positions& d) {
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index v = 0; v < d.rows(); ++v)
    sum += d.row(v).transpose() / scene.inverse_mass[static_cast<std::size_t>(v)];
  return sum;
}
Vec3 angular_momentum(const StepScene& scene, const Positions& d) {
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index v = 0; v < d.rows(); ++v) {
    const Vec3 x = scene.V_t0.row(v), velocity = d.row(v);
    sum += x.cross(velocity) / scene.inverse_mass[static_cast<std::size_t>(v)];
  }
  return sum;
}
double energy(const StepScene& scene, const Positions& d) {
  double sum = 0;
  for (Eigen::Index v = 0; v < d.rows(); ++v) {
    sum += d.row(v).squaredNorm() / scene.inverse_mass[static_cast<std::size_t>(v)] / 2;
  }
  return sum;
}

}  // namespace

TEST(CollisionStepProperties, ClothStaysFreeWhateverTheCandidates) {
  check_property(80, 101, [] {
    StepScene scene;
    Noise noise(*rc::gen::arbitrary<std::uint64_t>());
    random_options(scene);
    add_layers(scene, integer_in(1, 4), noise);
    RC_ASSERT(exact_defect(scene, scene.V_t0) == "");
    step_and_check(scene, noise, 3);
  });
}

TEST(CollisionStepProperties, ClothAmongBodiesStaysFreeAndScriptsAreFollowed) {
  check_property(60, 102, [] {
    StepScene scene;
    Noise noise(*rc::gen::arbitrary<std::uint64_t>());
    random_options(scene);
    add_layers(scene, integer_in(1, 3), noise);
    const double below_m = magnitude(-14, -7), above_m = magnitude(-14, -5);
    const double lowest = scene.V_t0.col(2).minCoeff(), highest = scene.V_t0.col(2).maxCoeff();
    scene.add(make_box(Vec3(0.08, 0.08, 0.02), 1), Vec3(0, 0, lowest - 0.01 - below_m), 0);
    scene.add(make_sphere(0.02, 1), Vec3(0.01 * noise(), 0, highest + 0.02 + above_m), 1);
    RC_ASSERT(exact_defect(scene, scene.V_t0) == "");
    step_and_check(scene, noise, 3);
  });
}

TEST(CollisionStepProperties, Float32ClothStaysFreeOnItsLattice) {
  check_property(40, 103, [] {
    StepScene scene;
    Noise noise(*rc::gen::arbitrary<std::uint64_t>());
    random_options(scene);
    scene.options.precision = Precision::kFloat32;
    add_layers(scene, integer_in(1, 4), noise);
    const double offset_m = integer_in(0, 2) == 0 ? 0 : magnitude(0, 8);
    scene.V_t0 = scene.V_t0.unaryExpr([=](double x) { return static_cast<double>(static_cast<float>(x + offset_m)); });
    RC_PRE(exact_defect(scene, scene.V_t0) == "");
    step_and_check(scene, noise, 3);
    RC_ASSERT(scene.V_t0 == scene.V_t0.cast<float>().cast<double>());
  });
}

/// What a step keeps for the next one saves work and changes nothing: it gives the bits of a step that knows of no
/// other.
TEST(CollisionStepProperties, NeitherHistoryNorAnAbandonedTryChangesAResult) {
  int abandoned = 0, taken = 0;
  check_property(60, 107, [&] {
    StepScene scene;
    Noise noise(*rc::gen::arbitrary<std::uint64_t>());
    random_options(scene);
    scene.policy = SqueezePolicy::kYield;
    add_layers(scene, integer_in(1, 4), noise);
    if (integer_in(0, 1) == 0) scene.add(make_sphere(0.02, 1), Vec3(0, 0, scene.V_t0.col(2).maxCoeff() + 0.03), 0);
    const Mesh mesh = scene.mesh();
    CollisionStep step(mesh, scene.options);
    for (int n = 0; n < 5; ++n) {
      if (integer_in(0, 2) > 0) attack(scene, random_attack(), noise);  // else the last candidates once more
      const Patience patience{integer_in(0, 8), integer_in(0, 4)};
      const auto result = step(scene.V_t0, scene.V_candidate, scene.bodies(), scene.dt_s, patience);
      const auto fresh = scene.step();
      const bool too_many = fresh.report.first_collisions > patience.collisions;
      const bool too_hard = fresh.report.impulse_rounds > patience.impulse_rounds || fresh.report.zone_rounds > 0 ||
                            fresh.report.fail_safe_rounds > 0 || !fresh.report.below_tolerance.empty();
      RC_ASSERT((result.report.status == StepStatus::kAbandoned) == (too_many || too_hard));
      if (result.report.status == StepStatus::kAbandoned) {
        ++abandoned;
        RC_ASSERT(result.x == scene.V_t0);
        if (integer_in(0, 1) == 0) {
          scene.V_candidate = 0.5 * (scene.V_t0 + scene.V_candidate);  // the shorter try
          continue;
        }
      }
      const auto again = step(scene.V_t0, scene.V_candidate, scene.bodies(), scene.dt_s);
      RC_ASSERT(again.x == fresh.x && again.velocity == fresh.velocity);
      RC_ASSERT(again.report.proximities == fresh.report.proximities);
      RC_ASSERT(again.report.first_collisions == fresh.report.first_collisions);
      scene.V_t0 = again.x;
      ++taken;
    }
  });
  EXPECT_GT(abandoned, 20);
  EXPECT_GT(taken, 20);
}

/// Three layers of cloth that an attack brings together, of which nothing adds energy.
StepScene closed_scene() {
  StepScene scene;
  Noise noise(*rc::gen::arbitrary<std::uint64_t>());
  random_options(scene);
  scene.options.repulsion_stiffness_n_m = 0;
  scene.options.tolerance_m = 0;  // the push to the tolerance is the one thing that adds energy
  scene.options.max_impulse_rounds = 10;
  add_layers(scene, 3, noise);
  for (double& inverse_mass : scene.inverse_mass) inverse_mass = inverse_mass > 0 ? inverse_mass : 1;
  attack(scene, static_cast<Attack>(integer_in(1, 4)), noise);
  return scene;
}

/// Whether the step kept the momentum about the positions at its start, too: not if it had zones, whose chords keep
/// sin(angle) / angle of it only.
enum class Keeps { kLinear, kBoth };
void expect_kept(const StepScene& scene, const CollisionStepResult& result, Keeps keeps) {
  const Positions before = (scene.V_candidate - scene.V_t0) / scene.dt_s;
  RC_ASSERT(energy(scene, result.velocity) <= energy(scene, before) * (1 + 1e-12));
  double scale = 0;
  for (Eigen::Index v = 0; v < before.rows(); ++v) {
    scale += before.row(v).norm() / scene.inverse_mass[static_cast<std::size_t>(v)];
  }
  RC_ASSERT((linear_momentum(scene, result.velocity) - linear_momentum(scene, before)).norm() <= 1e-12 * scale);
  if (keeps == Keeps::kLinear || result.report.zone_rounds > 0) return;
  RC_ASSERT((angular_momentum(scene, result.velocity) - angular_momentum(scene, before)).norm() <= 1e-12 * scale);
}

TEST(CollisionStepProperties, ImpulsesAndFrictionKeepMomentumAndAddNoEnergy) {
  int steps_with_impulses = 0;
  check_property(60, 104, [&] {
    const StepScene scene = closed_scene();
    const CollisionStepResult result = scene.step();
    RC_ASSERT(exact_defect(scene, result) == "");
    RC_PRE(result.report.fail_safe_rounds == 0);
    expect_kept(scene, result, Keeps::kBoth);
    steps_with_impulses += result.report.zone_rounds == 0 && result.report.impulse_rounds > 0 ? 1 : 0;
  });
  EXPECT_GT(steps_with_impulses, 10);  // else the property says nothing
}

/// Those that were found repel along the line of their points at the start. Those of collisions repel along the normal
/// of the collision, which is another line: they turn a pair.
TEST(CollisionStepProperties, HeldContactsKeepMomentumAndAddNoEnergy) {
  int found_repelled = 0, met_repelled = 0;
  check_property(60, 105, [&] {
    StepScene scene = closed_scene();
    scene.options.repulsion = true;
    const Mesh mesh = scene.mesh();
    CollisionStep step(mesh, scene.options);
    const auto step_with = [&](const std::vector<RepulsionContact>& held, Keeps keeps, int& repelled) {
      const auto result = step(scene.V_t0, scene.V_candidate, scene.bodies(), scene.dt_s, {}, held);
      RC_ASSERT(exact_defect(scene, result) == "");
      if (result.report.fail_safe_rounds == 0) expect_kept(scene, result, keeps);
      repelled += !held.empty() && result.report.repulsions > 0 ? 1 : 0;
      return result;
    };
    const auto found = step.find_contacts(scene.V_t0, scene.V_candidate, scene.bodies());
    const auto first = step_with(found, Keeps::kBoth, found_repelled);
    step_with(first.met, Keeps::kLinear, met_repelled);
  });
  EXPECT_GT(found_repelled, 10);
  EXPECT_GT(met_repelled, 10);
}

}  // namespace selvage::sim::testbed
