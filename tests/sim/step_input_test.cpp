#include "sim/step_input.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace selvage::sim::testbed {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Input {
  Mesh mesh;
  CollisionOptions options;
  Positions V_t0 = Positions::Random(3, 3), V_candidate = Positions::Random(3, 3);
  std::vector<double> inverse_mass{1, 1, 0};
  std::vector<std::int32_t> body{-1, -1, 0};
  SqueezePolicy policy = SqueezePolicy::kStop;
  std::int32_t first_pin = 1;
  double dt_s = 1e-2;
  Input() {
    Faces F(1, 3);
    F << 0, 1, 2;
    mesh = make_mesh(3, F);
  }
  [[nodiscard]] InputError error() const {
    return validate_step_input(mesh, options, V_t0, V_candidate, {inverse_mass, body, policy, first_pin}, dt_s);
  }
};

}  // namespace

TEST(StepInput, GoodInputIsTaken) {
  Input input;
  EXPECT_EQ(input.error(), InputError::kNone);
  input.body.clear();
  EXPECT_EQ(input.error(), InputError::kNone);
}

TEST(StepInput, NamesTheDefect) {
  const auto error_after = [](auto spoil) {
    Input input;
    spoil(input);
    return input.error();
  };
  EXPECT_EQ(error_after([](Input& i) { i.V_candidate.resize(2, 3); }), InputError::kSizeMismatch);
  EXPECT_EQ(error_after([](Input& i) { i.inverse_mass.pop_back(); }), InputError::kSizeMismatch);
  EXPECT_EQ(error_after([](Input& i) { i.body.pop_back(); }), InputError::kSizeMismatch);
  EXPECT_EQ(error_after([](Input& i) { i.V_candidate(1, 1) = kNan; }), InputError::kNotFinite);
  EXPECT_EQ(error_after([](Input& i) { i.V_candidate(1, 1) = 0x1.8p+1000; }), InputError::kNone);  // cut by the step
  EXPECT_EQ(error_after([](Input& i) { i.V_candidate(2, 1) = 0x1.8p+1000; }), InputError::kTooLarge);  // a script
  EXPECT_EQ(error_after([](Input& i) {
              i.options.precision = Precision::kFloat32;
              i.V_candidate(2, 1) = 1e200;
            }),
            InputError::kTooLarge)
      << "no float32";
  for (const double mass : {-1.0, kNan, kInfinity}) {
    EXPECT_EQ(error_after([=](Input& i) { i.inverse_mass[0] = mass; }), InputError::kBadMass);
  }
  EXPECT_EQ(error_after([](Input& i) { i.inverse_mass[2] = 1; }), InputError::kBadMass);  // a body with mass
  EXPECT_EQ(error_after([](Input& i) { i.body[1] = -2; }), InputError::kBadBodies);
  EXPECT_EQ(error_after([](Input& i) { i.policy = static_cast<SqueezePolicy>(77); }), InputError::kBadBodies);
  EXPECT_EQ(error_after([](Input& i) { i.policy = SqueezePolicy::kYield; }), InputError::kNone);
  EXPECT_EQ(error_after([](Input& i) { i.first_pin = -5; }), InputError::kBadBodies);
  EXPECT_EQ(error_after([](Input& i) { i.first_pin = 0; }), InputError::kNone);
  for (const double dt_s : {0.0, -1e-2, kNan, kInfinity}) {
    EXPECT_EQ(error_after([=](Input& i) { i.dt_s = dt_s; }), InputError::kBadTimeStep);
  }
  EXPECT_EQ(error_after([](Input& i) {
              i.options.precision = Precision::kFloat32;
              i.V_t0(0, 0) = 0.1;
            }),
            InputError::kOffLattice);
}

TEST(StepInput, OptionsOutsideTheirRangesAreRefusedByName) {
  const auto bad_after = [](auto spoil) {
    CollisionOptions options;
    spoil(options);
    return std::string(first_bad_option(options));
  };
  using Options = CollisionOptions;
  EXPECT_EQ(bad_after([](Options&) {}), "");
  for (const double bad : {-1.0, kNan, kInfinity}) {
    EXPECT_EQ(bad_after([=](Options& o) { o.thickness_m = bad; }), "thickness_m");
    EXPECT_EQ(bad_after([=](Options& o) { o.tolerance_m = bad; }), "tolerance_m");
    EXPECT_EQ(bad_after([=](Options& o) { o.repulsion_stiffness_n_m = bad; }), "repulsion_stiffness_n_m");
    EXPECT_EQ(bad_after([=](Options& o) { o.overlap_fraction = bad; }), "overlap_fraction");
    EXPECT_EQ(bad_after([=](Options& o) { o.relaxation = bad; }), "relaxation");
    EXPECT_EQ(bad_after([=](Options& o) { o.friction_static = bad; }), "friction_static");
    EXPECT_EQ(bad_after([=](Options& o) { o.friction_kinetic = bad; }), "friction_kinetic");
  }
  for (double Options::*length : {&Options::thickness_m, &Options::tolerance_m}) {
    EXPECT_EQ(bad_after([=](Options& o) { o.*length = kMaxCoordinate; }), "");
    EXPECT_NE(bad_after([=](Options& o) { o.*length = 1.5 * kMaxCoordinate; }), "");
  }
  EXPECT_EQ(bad_after([](Options& o) { o.relaxation = 0; }), "relaxation");
  EXPECT_EQ(bad_after([](Options& o) { o.friction_kinetic = 0.1; }), "friction_kinetic") << "above the static one";
  EXPECT_EQ(bad_after([](Options& o) { o.max_impulse_rounds = -1; }), "max_impulse_rounds");
  EXPECT_EQ(bad_after([](Options& o) { o.max_zone_rounds = -1; }), "max_zone_rounds");
  EXPECT_EQ(bad_after([](Options& o) { o.max_intervals = 0; }), "max_intervals");
  Input input;
  input.options.relaxation = 2;
  EXPECT_EQ(input.error(), InputError::kBadOption);
}

}  // namespace selvage::sim::testbed
