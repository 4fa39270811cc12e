#include <limits>

#include <fmt/format.h>

#include "bench/stability/cases.h"
#include "bench/stability/exact_watch.h"
#include "bench/stability/stage.h"
#include "io/error.h"
#include "sim/base/points.h"
#include "sim/scene/scene_reader.h"
#include "sim/world.h"
#include "verify/check.h"

namespace selvage::bench {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Two sheets, one above the other, and everything that one step takes.
struct StepInput {
  explicit StepInput(const Trial& trial) {
    const int side = trial.pick(3, 8, 20);
    const sim::Shape sheet = sim::make_sheet(side, side, 1, 1);
    const Eigen::Index n = sheet.x.rows();
    x.resize(2 * n, 3);
    x << sheet.x, sheet.x;
    x.bottomRows(n).col(2).array() += 0.01;
    x.rowwise() += trial.offset(1).transpose();
    candidate = x;
    candidate.bottomRows(n).col(2).array() -= 0.02;
    const auto face_count = static_cast<Eigen::Index>(sheet.triangles.size());
    faces.resize(2 * face_count, 3);
    for (Eigen::Index f = 0; f < 2 * face_count; ++f) {
      for (Eigen::Index k = 0; k < 3; ++k) {
        const auto corner = sheet.triangles[static_cast<std::size_t>(f % face_count)][static_cast<std::size_t>(k)];
        faces(f, k) = corner + (f < face_count ? 0 : static_cast<std::int32_t>(n));
      }
    }
    inverse_mass.assign(static_cast<std::size_t>(2 * n), 1000);
  }

  [[nodiscard]] sim::CollisionStepResult run(sim::CollisionStep& step) const {
    return step(x, candidate, {inverse_mass, {}, sim::SqueezePolicy::kStop}, dt_s);
  }

  Positions x, candidate;
  Faces faces;
  std::vector<double> inverse_mass;
  double dt_s = 0.01;
};

/// `spoil` makes the input of one step invalid: it must be refused with `error` and move nothing, and the step must
/// afterwards give the bits of one that never saw it.
template <class Spoil>
void refuses(Trial& trial, InputError error, Spoil spoil) {
  const StepInput good(trial);
  const Mesh mesh = make_mesh(static_cast<std::int32_t>(good.x.rows()), good.faces);
  sim::CollisionStep step(mesh, {}), untouched(mesh, {});
  StepInput bad = good;
  spoil(bad);
  const sim::CollisionStepResult refused = bad.run(step);
  trial.require(refused.report.status == sim::StepStatus::kInvalidInput, "it was not refused");
  trial.require(refused.report.input_error == error,
                fmt::format("the error is \"{}\"", describe(refused.report.input_error)));
  trial.require(sim::same_bits(refused.x, bad.x) && refused.velocity.isZero(0), "a refused step moved something");
  const sim::CollisionStepResult after = good.run(step), alone = good.run(untouched);
  trial.require(after.report.status == sim::StepStatus::kSafe && after.x == alone.x && after.velocity == alone.velocity,
                "the step after it gave other bits");
  trial.report().vertices = good.x.rows();
  trial.report().faces = good.faces.rows();
  ++trial.report().steps;
}

void dt_zero(Trial& trial) {
  refuses(trial, InputError::kBadTimeStep, [](StepInput& input) { input.dt_s = 0; });
}
void dt_negative(Trial& trial) {
  refuses(trial, InputError::kBadTimeStep, [](StepInput& input) { input.dt_s = -0.01; });
}
void dt_no_number(Trial& trial) {
  refuses(trial, InputError::kBadTimeStep, [](StepInput& input) { input.dt_s = kNan; });
  refuses(trial, InputError::kBadTimeStep, [](StepInput& input) { input.dt_s = kInfinity; });
}
void mass_zero(Trial& trial) {
  refuses(trial, InputError::kBadMass, [](StepInput& input) { input.inverse_mass[1] = kInfinity; });
}
void mass_bad(Trial& trial) {
  refuses(trial, InputError::kBadMass, [](StepInput& input) { input.inverse_mass[1] = -1; });
  refuses(trial, InputError::kBadMass, [](StepInput& input) { input.inverse_mass[1] = kNan; });
  refuses(trial, InputError::kSizeMismatch, [](StepInput& input) { input.inverse_mass.pop_back(); });
}
void nan_position(Trial& trial) {
  refuses(trial, InputError::kNotFinite, [](StepInput& input) { input.candidate(3, 1) = kNan; });
  refuses(trial, InputError::kNotFinite, [](StepInput& input) { input.candidate(3, 1) = -kInfinity; });
  refuses(trial, InputError::kNotFinite, [](StepInput& input) { input.x(0, 0) = kNan; });
}

void dt_tiny(Trial& trial) {
  // A valid step: the positions do not depend on dt, and velocities end at the largest double.
  StageSetup setup;
  const int side = trial.pick(3, 8, 20);
  for (int layer = 0; layer < 2; ++layer) {
    setup.add_cloth(sim::make_sheet(side, side, 1, 1), Vec3(0.01, 0.02, 0.01) * layer);
  }
  for (const double dt_s : {1e-300, 5e-324}) {
    setup.dt_s = dt_s;
    Stage stage(trial, setup);
    Positions candidate = stage.x();
    candidate.bottomRows(side * side).col(2).array() -= 0.02;
    trial.require(stage.step_to(candidate).first_collisions > 0, "no contact was found");
    trial.require(stage.v().allFinite(), "a velocity is not finite");
  }
}

void intersecting_start(Trial& trial) {
  const StepInput input(trial);
  Positions crossing = input.x;
  crossing.bottomRows(crossing.rows() / 2).col(2) +=
      0.1 * (crossing.bottomRows(crossing.rows() / 2).col(0).array() - trial.offset(1).x()).matrix();
  io::Triangles triangles;
  for (Eigen::Index f = 0; f < input.faces.rows(); ++f) {
    triangles.push_back({input.faces(f, 0), input.faces(f, 1), input.faces(f, 2)});
  }
  const verify::Topology topology = verify::make_topology({triangles}, static_cast<std::size_t>(crossing.rows()));
  const verify::CheckResult result = verify::check_frame(topology, sim::points_of(crossing), {});
  trial.at_least("violations named", double(result.violations.size()), 1);
}

void bad_scenes(Trial& trial) {
  // One error that names the line, and nothing run.
  const int n = trial.pick(4, 40, 400);
  const auto scene = [n](const std::string& time, const std::string& cloth) {
    return fmt::format(
        "[time]\nframes = 1\n{}\n[[cloth]]\nsheet = {{nx = {}, ny = 4, width_m = 1, height_m = 1}}\n{}\n", time, n,
        cloth);
  };
  const std::string good_cloth = "density_kg_m2 = 0.2\nstretch_n_m = 50";
  int refused = 0;
  const std::vector<std::string> bad = {scene("max_step_s = 0", good_cloth),
                                        scene("max_step_s = -0.01", good_cloth),
                                        scene("max_step_s = 1e-300", good_cloth),
                                        scene("frames_per_s = 0", good_cloth),
                                        scene("frames_per_s = -30", good_cloth),
                                        scene("dynamics_step_s = nan", good_cloth),
                                        scene("", "density_kg_m2 = 0\nstretch_n_m = 50"),
                                        scene("", "density_kg_m2 = nan\nstretch_n_m = 50"),
                                        scene("", good_cloth + "\nvelocity_m_s = [0, 0, nan]"),
                                        scene("", good_cloth + "\nposition_m = [inf, 0, 0]"),
                                        scene("", "density_kg_m2 = -1\nstretch_n_m = 50")};
  for (const std::string& text : bad) {
    try {
      const sim::Scene accepted = sim::parse_scene(text, "scene.toml", sim::Quality::kDraft);
      trial.require(false, fmt::format("a bad scene was accepted:\n{}", text));
    } catch (const io::Error& error) {
      const std::string what = error.what();
      trial.require(what.starts_with("scene.toml:"), "the error does not name its place: " + what);
      ++refused;
    }
  }
  trial.at_least("scenes refused", refused, double(bad.size()));
}

}  // namespace

std::vector<StabilityCase> input_cases() {
  return {
      {"dt-zero", "no time passes", "one clear error, and nothing is lost", dt_zero},
      {"dt-negative", "time runs back", "one clear error, and nothing is lost", dt_negative},
      {"dt-no-number", "dt is NaN or infinite", "one clear error, and nothing is lost", dt_no_number},
      {"dt-tiny", "dt of 1e-300 and of the smallest double", "a step like any other; velocities finite", dt_tiny},
      {"mass-zero", "a vertex without mass", "one clear error, and nothing is lost", mass_zero},
      {"mass-bad", "masses negative, NaN, or one too few", "one clear error, and nothing is lost", mass_bad},
      {"nan-position", "a coordinate is NaN or infinite, at either end", "one clear error, and nothing is lost",
       nan_position},
      {"intersecting-start", "the state is not free at the start", "the exact check names the pairs",
       intersecting_start},
      {"bad-scenes", "steps, densities and places that make no sense", "one error each that names the line",
       bad_scenes},
  };
}

}  // namespace selvage::bench
