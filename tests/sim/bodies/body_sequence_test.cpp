// Bodies that a sequence of meshes animates.
#include "sim/bodies/body_sequence.h"

#include <cmath>
#include <fstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "io/sequence.h"
#include "sim/base/points.h"
#include "sim/record/scene_identity.h"
#include "sim/scene/scene_reader.h"
#include "sim/scene/shapes.h"
#include "sim/step.h"
#include "tests/sim/exact_step.h"
#include "tests/sim/foot_scene.h"
#include "tests/sim/small_scene.h"

namespace selvage::sim {
namespace {

constexpr int kBodyFrames = 13;  // 12 a second
constexpr double kFrame_s = 1.0 / 12;

/// A ball that rises, swells and leans over: no rigid motion.
Positions ball(double time_s) {
  static const Positions still = make_sphere(0.1, 2).x;
  Positions x = still * (1 + 0.3 * std::sin(2 * time_s));
  x.col(0) += 0.5 * time_s * x.col(2);
  x.col(2).array() += 0.15 * std::sin(3 * time_s);
  return x;
}

std::string obj(const Positions& x) {
  std::string text;
  for (Eigen::Index v = 0; v < x.rows(); ++v) text += fmt::format("v {} {} {}\n", x(v, 0), x(v, 1), x(v, 2));
  for (const auto& t : make_sphere(0.1, 2).triangles) text += fmt::format("f {} {} {}\n", t[0] + 1, t[1] + 1, t[2] + 1);
  return text;
}

class BodySequenceTest : public ::testing::Test {
 protected:
  void spit(const std::string& name, const std::string& text) const { std::ofstream(folder_.path() / name) << text; }
  [[nodiscard]] std::filesystem::path scene_file() const { return folder_.path() / "scene.toml"; }
  void write_frames() const {
    for (int i = 0; i < kBodyFrames; ++i) spit("ball_" + std::to_string(i) + ".obj", obj(ball(i * kFrame_s)));
  }
  [[nodiscard]] SequenceSpec spec() const {
    return {.file = "ball_*.obj", .base = {}, .scale = 1, .frames_per_s = 12, .start_s = 0, .line = 7};
  }
  [[nodiscard]] std::string error_of(const SequenceSpec& bad) const {
    try {
      const BodySequence sequence(bad, scene_file());
    } catch (const io::Error& error) {
      return error.what();
    }
    return "";
  }
  /// A sheet that falls on it.
  [[nodiscard]] Scene scene(const std::string& more = "") const {
    spit("scene.toml", R"(gravity_m_s2 = [0, 0, -9.81]
[time]
duration_s = 1
[collision]
thickness_m = 0.005
friction_static = 0.4
[[cloth]]
sheet = {nx = 16, ny = 16, width_m = 0.6, height_m = 0.6}
position_m = [0.02, 0.01, 0.13]
density_kg_m2 = 0.3
stretch_n_m = 40
shear_n_m = 20
bend_n_m = 0.5
damping_ratio = 0.1
[[body]]
sequence = {file = "ball_*.obj", frames_per_s = 12}
)" + more);
    return read_scene(scene_file());
  }

  testing::TemporaryFolder folder_;
};

}  // namespace

TEST_F(BodySequenceTest, IsAtItsFramesToTheBitAndStraightBetweenThem) {
  write_frames();
  SequenceSpec moved = spec();
  moved.start_s = 0.5;
  moved.scale = 0.5;
  const BodySequence sequence(moved, scene_file());
  ASSERT_EQ(sequence.frame_count(), kBodyFrames);
  const auto frame = [](int i) { return Positions(0.5 * ball(i * kFrame_s)); };
  EXPECT_EQ(sequence.at(-1), frame(0)) << "stands still before the first frame";
  EXPECT_EQ(sequence.at(100), frame(kBodyFrames - 1)) << "and after the last";
  for (const int i : {0, 7, 3, kBodyFrames - 1}) EXPECT_EQ(sequence.at(0.5 + i / 12.0), frame(i)) << i;
  const Positions between = sequence.at(0.5 + 3.25 / 12);
  EXPECT_LT((between - (0.75 * frame(3) + 0.25 * frame(4))).cwiseAbs().maxCoeff(), 1e-15);
}

TEST_F(BodySequenceTest, OfAFolderHasItsTimesOrAsManyFramesASecondAsAreAskedFor) {
  const std::vector<double> times_s = {0.5, 1, 2.5};  // not evenly
  {
    io::SequenceHeader header;
    header.triangles = make_sphere(0.1, 2).triangles;
    io::SequenceWriter writer(folder_.path() / "run", header);
    for (const double time_s : times_s) writer.append(time_s, points_of(ball(time_s)));
  }
  SequenceSpec run = spec();
  run.file = "run";
  run.frames_per_s.reset();
  const BodySequence own(run, scene_file());  // since the first
  EXPECT_EQ(own.at(0.5), ball(1));
  EXPECT_EQ(own.at(2), ball(2.5));
  EXPECT_LT((own.at(0.875) - (0.75 * ball(1) + 0.25 * ball(2.5))).cwiseAbs().maxCoeff(), 1e-15);
  run.frames_per_s = 4;
  const BodySequence even(run, scene_file());
  EXPECT_EQ(even.at(0.25), ball(1));
  EXPECT_EQ(even.at(0.5), ball(2.5));
}

TEST_F(BodySequenceTest, EveryStepOnItIsExactlyFree) {
  write_frames();
  for (const std::string solver : {"explicit", "implicit"}) {
    Scene falling = scene();
    falling.solver = solver == "explicit" ? Solver::kExplicit : Solver::kImplicit;
    falling.strain.strain_rate = 0;
    Simulation simulation(falling);
    const World& world = simulation.world();
    std::int64_t contacts = 0;
    testing::run_exactly_free(simulation, simulation.scene().time.frame_count, [&](const StepResult& step) {
      contacts += step.report.repulsions;
      const Collider& body = world.colliders.front();
      EXPECT_EQ(Positions(simulation.x()(body.vertices(), Eigen::all)),
                body.sequence()->at(simulation.clock().time_s()))
          << "to the bit where its frames are, at " << simulation.clock().time_s() << " s";
    });
    EXPECT_GT(contacts, 1000);
  }
}

// There and back, at 18 m/s, between two frames of the scene and before the first quarter of a step that meets both.
TEST_F(BodySequenceTest, FramesWithinAStepAreMet) {
  for (int i = 0; i < 4; ++i) {
    Positions x = make_sphere(0.1, 2).x;
    x.col(2).array() += i == 1 ? 0.1 : -0.2;
    spit("ball_" + std::to_string(i) + ".obj", obj(x));
  }
  spit("scene.toml", R"([time]
frames_per_s = 6
frames = 1
[collision]
thickness_m = 0.005
[[cloth]]
sheet = {nx = 10, ny = 10, width_m = 0.4, height_m = 0.4}
density_kg_m2 = 0.2
stretch_n_m = 200
shear_n_m = 20
damping_ratio = 0.1
[[cloth.pin]]
edge = "left"
[[cloth.pin]]
edge = "right"
[[body]]
sequence = {file = "ball_*.obj", frames_per_s = 60}
)");
  Simulation simulation(read_scene(scene_file()));
  const Collider& body = simulation.world().colliders.front();
  EXPECT_NEAR(body.bend(0, 1 / 6.0).leaves_line_by_m, 0.3, 1e-15);
  EXPECT_LE(body.bend(0, 1 / 6.0).within.min().z(), -0.3);
  EXPECT_GE(body.bend(0, 1 / 6.0).within.max().z(), 0.2);
  EXPECT_EQ(body.bend(1 / 60.0, 2 / 60.0).leaves_line_by_m, 0) << "straight from frame to frame";
  EXPECT_EQ(body.bend(2 / 60.0, 1 / 6.0).leaves_line_by_m, 0) << "stands still";
  std::int64_t contacts = 0, bent_steps = 0;
  testing::run_exactly_free(simulation, 1, [&](const StepResult& step) {
    contacts += step.report.repulsions + step.report.first_collisions;
    bent_steps += step.is_bent ? 1 : 0;
  });
  EXPECT_GT(contacts, 0);
  EXPECT_EQ(bent_steps, 0);
}

TEST_F(BodySequenceTest, CarriesWhatIsPinnedToIt) {
  write_frames();
  Scene hung = scene("name = \"ball\"\n");
  PinSpec pin;
  pin.vertices = {119, 120, 135, 136};
  pin.script.keys.emplace_back();
  pin.body = 0;
  hung.cloths[0].pins = {pin};
  Simulation simulation(hung);
  const World& world = simulation.world();
  const Positions x_t0 = simulation.x();
  testing::run_exactly_free(simulation, 30, [&](const StepResult&) {
    const Positions carried =
        world.colliders.back().placed_at(simulation.clock().time_s(), Precision::kFloat64, simulation.x());
    ASSERT_EQ(Positions(simulation.x()(pin.vertices, Eigen::all)), carried);
  });
  const auto above = [](const Positions& x) {
    return (x.bottomRows(make_sphere(0.1, 2).x.rows()).rowwise() - x.row(119)).rowwise().norm().minCoeff();
  };
  EXPECT_NEAR(above(simulation.x()), above(x_t0), 0.01) << "0.03 m over a ball that leans over and moves by 0.15 m";
}

// Two slabs of one figure that close on the border of a sheet, a little through each other, and open again.
TEST_F(BodySequenceTest, UnderYieldGivesWayWhereItIsInTheWayAndComesBack) {
  const Shape slab = make_box(Vec3(0.3, 0.3, 0.02), 4);
  const auto n = slab.x.rows();
  for (int i = 0; i <= 30; ++i) {
    Positions jaws(2 * n, 3);
    jaws << slab.x, slab.x;
    jaws.bottomRows(n).col(2).array() += 0.05 - 0.035 * std::sin(i * 0.1047);
    std::string text;
    for (Eigen::Index v = 0; v < 2 * n; ++v) text += fmt::format("v {} {} {}\n", jaws(v, 0), jaws(v, 1), jaws(v, 2));
    for (const Eigen::Index begin : {Eigen::Index{1}, n + 1}) {
      for (const auto& t : slab.triangles)
        text += fmt::format("f {} {} {}\n", t[0] + begin, t[1] + begin, t[2] + begin);
    }
    spit("jaws_" + std::to_string(i) + ".obj", text);
  }
  spit("jaws.toml", R"(squeeze = "yield"
[time]
frames = 40
min_step_s = 0.008
[collision]
thickness_m = 0.004
[[cloth]]
sheet = {nx = 6, ny = 6, width_m = 0.2, height_m = 0.2}
position_m = [0.2, 0, 0.025]
density_kg_m2 = 0.2
stretch_n_m = 60
damping_ratio = 0.2
[[body]]
sequence = {file = "jaws_*.obj", frames_per_s = 30}
)");
  Simulation simulation(read_scene(folder_.path() / "jaws.toml"));
  const Collider& body = simulation.world().colliders.front();
  std::int64_t most_lag = 0, waits = 0;
  Eigen::Index lag = 0;
  testing::run_exactly_free(simulation, 40, [&](const StepResult& step) {
    waits += std::ssize(step.report.waiting_bodies);
    const Positions script = body.placed_at(simulation.clock().time_s(), Precision::kFloat64, simulation.x());
    lag = (simulation.x()(body.vertices(), Eigen::all) - script).rowwise().any().count();
    most_lag = std::max(most_lag, std::int64_t{lag});
  });
  EXPECT_GT(waits, 0);
  EXPECT_GT(most_lag, 3);
  EXPECT_LT(most_lag, n / 2) << "of the upper slab what is over the sheet";
  EXPECT_EQ(lag, 0) << "back to the bit";
}

// A foot that steps 3.5 mm too deep on a hem, and slides on. What was in the way stood still, and the foot was drawn
// out to 0.27 m.
TEST_F(BodySequenceTest, GoesOnAlongWhatBlocksIt) {
  const Shape foot = make_sphere(0.03, 2);
  for (int i = 0; i <= 24; ++i) {
    const double t = i / 30.0, down = std::min(t / 0.2, 1.0), up = std::max(0.0, (t - 0.6) / 0.1);
    const Vec3 at(0.1 + 0.75 * std::clamp(t - 0.3, 0.0, 0.3), 0, 0.06 - 0.0335 * down + 0.1 * up);
    std::string text;
    for (Eigen::Index v = 0; v < foot.x.rows(); ++v) {
      const Vec3 x = foot.x.row(v).transpose() + at;
      text += fmt::format("v {} {} {}\n", x.x(), x.y(), x.z());
    }
    for (const auto& f : foot.triangles) text += fmt::format("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1);
    spit("foot_" + std::to_string(i) + ".obj", text);
  }
  spit("hem.toml", testbed::foot_scene_text("sequence = {file = \"foot_*.obj\", frames_per_s = 30}"));
  Simulation simulation(read_scene(folder_.path() / "hem.toml"));
  const Collider& body = simulation.world().colliders.front();
  double farthest_behind_m = 0;
  std::int64_t waits = 0;
  testing::run_exactly_free(simulation, 24, [&](const StepResult& step) {
    waits += std::ssize(step.report.waiting_bodies);
    EXPECT_EQ(step.report.fail_safe_vertices, 0);
    farthest_behind_m = std::max(farthest_behind_m, testbed::behind_script_m(simulation, body));
  });
  EXPECT_GT(waits, 10);
  EXPECT_LT(farthest_behind_m, 0.02);
  EXPECT_EQ(testbed::behind_script_m(simulation, body), 0);
}

TEST_F(BodySequenceTest, ThatChangesIsAnotherScene) {
  write_frames();
  const Scene same = scene();
  const SceneIdentity before = identify(same, build_world(same));
  EXPECT_EQ(identify(same, build_world(same)), before);
  spit("ball_9.obj", obj(ball(9.01 * kFrame_s)));
  EXPECT_NE(identify(same, build_world(same)), before) << "one frame, long after the start";
}

// The same frames at other times.
TEST_F(BodySequenceTest, ThatTakesOtherTimesIsAnotherScene) {
  const auto record = [&](double last_s) {
    std::filesystem::remove_all(folder_.path() / "ball");
    io::SequenceHeader header;
    header.triangles = make_sphere(0.1, 2).triangles;
    io::SequenceWriter writer(folder_.path() / "ball", header);
    for (const double time_s : {0.0, 0.25, last_s}) writer.append(time_s, points_of(ball(time_s == 0 ? 0 : 0.25)));
  };
  record(0.5);
  SequenceSpec timed = spec();
  timed.file = "ball";
  timed.frames_per_s.reset();
  const std::uint32_t before = BodySequence(timed, scene_file()).checksum();
  EXPECT_EQ(BodySequence(timed, scene_file()).checksum(), before);
  record(0.75);
  EXPECT_NE(BodySequence(timed, scene_file()).checksum(), before);
}

TEST_F(BodySequenceTest, HangsOnAParentAndFollowsKeys) {
  write_frames();
  const Scene moved = scene("name = \"ball\"\nposition_m = [1, 0, 0]\nrotation_deg = [0, 0, 90]\n");
  const World world = build_world(moved);
  const Positions placed = world.colliders.front().placed_at(7 / 12.0, Precision::kFloat64, world.x_t0),
                  own = ball(7 * kFrame_s);
  EXPECT_LT((placed.col(0).array() - (1 - own.col(1).array())).abs().maxCoeff(), 1e-15);
  EXPECT_LT((placed.col(1) - own.col(0)).cwiseAbs().maxCoeff(), 1e-15);
}

TEST_F(BodySequenceTest, WhatIsWrongNamesTheLineAndTheRemedy) {
  EXPECT_NE(error_of(spec()).find("scene.toml:7: sequence: "), std::string::npos) << error_of(spec());
  EXPECT_NE(error_of(spec()).find("no file has such a name"), std::string::npos) << error_of(spec());
  write_frames();
  EXPECT_EQ(error_of(spec()), "");
  SequenceSpec bad = spec();
  bad.frames_per_s.reset();
  EXPECT_NE(error_of(bad).find("does not say when its frames are; add frames_per_s"), std::string::npos)
      << error_of(bad);
  bad = spec();
  bad.scale = 1e11;
  EXPECT_NE(error_of(bad).find("beyond 1e+09 m"), std::string::npos) << error_of(bad);
  std::filesystem::rename(folder_.path() / "ball_5.obj", folder_.path() / "away.obj");
  EXPECT_NE(error_of(spec()).find("ball_5.obj: cannot open: "), std::string::npos) << error_of(spec());
  std::string turned = obj(ball(5 * kFrame_s));
  const auto last = turned.rfind("f ");
  turned.replace(last, std::string::npos, "f 1 2 3\n");
  spit("ball_5.obj", turned);
  EXPECT_NE(error_of(spec()).find("ball_5.obj has other faces or vertices than the first frame"), std::string::npos)
      << "as many of both";
  const std::string whole = obj(ball(5 * kFrame_s));
  spit("ball_5.obj", whole + "v 0 0 0\n");
  EXPECT_NE(error_of(spec()).find("ball_5.obj has other faces or vertices than the first frame"), std::string::npos)
      << "a vertex of no face";
  spit("ball_5.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_NE(error_of(spec()).find("ball_5.obj has other faces or vertices than the first frame"), std::string::npos)
      << error_of(spec());
}

}  // namespace selvage::sim
