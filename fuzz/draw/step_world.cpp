#include "fuzz/draw/step_world.h"

#include <cmath>

#include "kernel/assert.h"

namespace selvage::fuzz {
namespace {

/// Where the draft is put: noise within the gaps, then scaled, then moved.
struct Setting {
  double noise = 0;  ///< largest displacement a coordinate, a share of the gap
  std::uint64_t noise_seed = 0;
  int scale_exponent = 0;
  Vec3 offset = Vec3::Zero();
};

Setting choose_setting(ChoiceSource& source) {
  Setting setting;
  // One choice for the whole field: a few parameters shrink well, a thousand coordinates do not.
  setting.noise_seed = source.n(1U << 16);
  if (setting.noise_seed != 0) setting.noise = std::ldexp(1.0, -source.range(3, 12));
  setting.scale_exponent = static_cast<int>(source.one_in(8) ? source.zigzag(300) : source.zigzag(10));
  if (source.coin()) {
    // Up to 2^24 spacings away, where gaps of 2^-30 no longer exist: such settings are given up below.
    for (double& coordinate : setting.offset) {
      const auto multiple = static_cast<double>(source.zigzag(3));
      coordinate = std::ldexp(multiple, setting.scale_exponent + source.range(0, 22));
    }
  }
  return setting;
}

Positions placed(const SurfaceDraft& draft, const Setting& setting, bool on_float32_lattice) {
  Positions x(static_cast<Eigen::Index>(draft.x.size()), 3);
  ChoiceSource noise = ChoiceSource::from_seed(setting.noise_seed);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const double moved = draft.x[static_cast<std::size_t>(i)][axis] + setting.noise * draft.gap * noise.signed_real();
      const double coordinate = std::ldexp(moved, setting.scale_exponent) + setting.offset[axis];
      x(i, axis) = on_float32_lattice ? static_cast<double>(static_cast<float>(coordinate)) : coordinate;
    }
  }
  return x;
}

double choose_length(ChoiceSource& source, double gap) {
  switch (source.n(4)) {
    case 1:
      return 0x1p-20 * gap;
    case 2:
      return gap / 4;
    case 3:
      return 2 * gap;
    default:
      return 0;
  }
}

sim::CollisionOptions choose_step_options(ChoiceSource& source, double gap) {
  sim::CollisionOptions options;
  options.thickness_m = choose_length(source, gap);
  options.tolerance_m = choose_length(source, gap);
  options.repulsion = source.coin();
  if (source.one_in(4)) options.repulsion_stiffness_n_m = 100;
  if (source.coin()) {
    options.friction_static = 0.6;
    options.friction_kinetic = 0.5;
  }
  // Short of rounds, so that every stage gets work, the fail-safe most of all.
  options.max_impulse_rounds = source.range(0, 4);
  options.max_zone_rounds = source.range(0, 3);
  if (source.one_in(4)) options.precision = sim::CollisionOptions::Precision::kFloat32;
  if (source.one_in(16)) options.max_intervals = source.range(1, 64);
  return options;
}

void choose_masses(ChoiceSource& source, const SurfaceDraft& draft, StepWorld& world) {
  world.body = draft.body;
  const bool equal = !source.coin();
  const bool pinned = source.one_in(4);
  for (const std::int32_t body : draft.body) {
    const double mass = equal ? 1 : std::ldexp(1.0, static_cast<int>(source.zigzag(6)));
    world.inverse_mass.push_back(body >= 0 ? 0 : 1 / mass);
  }
  if (pinned) world.inverse_mass[0] = 0;
}

/// Whether all corners of the face are scripted: what such faces do to each other is not the step's business.
std::vector<std::uint8_t> body_faces(const StepWorld& world, const Triples& faces) {
  std::vector<std::uint8_t> flags;
  for (const auto& face : faces) {
    flags.push_back(world.is_scripted(face[0]) && world.is_scripted(face[1]) && world.is_scripted(face[2]));
  }
  return flags;
}

}  // namespace

double choose_length(ChoiceSource& source, const StepWorld& world) {
  return source.coin() ? std::ldexp(world.gap_m, source.range(-20, 3)) : 0;
}

std::vector<std::uint8_t> choose_active(ChoiceSource& source, const StepWorld& world) {
  std::vector<std::uint8_t> active;
  if (!source.coin()) return active;
  for (Eigen::Index i = 0; i < world.x.rows(); ++i) active.push_back(source.n(4) == 1 ? 1 : 0);
  return active;
}

std::int64_t cloth_violations(const StepWorld& world, const verify::CheckResult& result) {
  std::int64_t count = 0;
  for (const verify::Violation& violation : result.violations) {
    bool all_scripted = true;
    for (const std::int32_t vertex : violation.vertices) all_scripted &= vertex < 0 || world.is_scripted(vertex);
    count += !all_scripted;
  }
  // Those beyond the list are of unknown vertices: count them as the cloth's.
  return count + result.violations_total.total() - static_cast<std::int64_t>(result.violations.size());
}

void connect(StepWorld& world, const Triples& faces) {
  world.mesh = make_mesh(static_cast<std::int32_t>(world.inverse_mass.size()), faces);
  world.topology = verify::make_topology({faces, body_faces(world, faces)}, world.inverse_mass.size());
}

bool is_clean(const StepWorld& world, const Positions& x) {
  if (!x.allFinite()) return false;  // beyond the largest float32
  return cloth_violations(world, verify::check_frame(world.topology, sim::points_of(x), {})) == 0;
}

StepWorld make_step_world(ChoiceSource& source) {
  const std::vector<SurfaceClass>& classes = surface_classes();
  return make_step_world(source, classes[source.n(static_cast<std::uint32_t>(classes.size()))]);
}

StepWorld make_step_world(ChoiceSource& source, const SurfaceClass& surface) {
  const SurfaceDraft draft = surface.make(source);
  Setting setting = choose_setting(source);

  StepWorld world;
  world.surface = surface.name;
  world.spacing_m = std::ldexp(1.0, setting.scale_exponent);
  world.gap_m = draft.gap * world.spacing_m;
  world.options = choose_step_options(source, world.gap_m);
  world.policy = source.coin() ? sim::SqueezePolicy::kYield : sim::SqueezePolicy::kStop;
  world.dt_s = std::ldexp(1.0, -source.range(0, 10));
  choose_masses(source, draft, world);

  connect(world, draft.faces);

  const auto on_lattice = [&] { return world.options.precision == sim::CollisionOptions::Precision::kFloat32; };
  world.x = placed(draft, setting, on_lattice());
  if (!is_clean(world, world.x)) {
    setting.noise = 0;
    setting.offset.setZero();
    world.options.precision = sim::CollisionOptions::Precision::kFloat64;
    world.x = placed(draft, setting, on_lattice());
    SELVAGE_ASSERT(is_clean(world, world.x));
  }
  return world;
}

}  // namespace selvage::fuzz
