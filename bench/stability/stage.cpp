#include "bench/stability/stage.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <Eigen/Geometry>

#include "sim/cloth.h"
#include "sim/step_lengths.h"

namespace selvage::bench {
namespace {

StageSetup moved(StageSetup setup, const Vec3& offset) {
  setup.x.rowwise() += offset.transpose();
  for (StageSetup::Scripted& scripted : setup.scripted) {
    for (sim::PoseKey& key : scripted.keys) key.pose.position_m += offset;
    const Positions placed = sim::place(scripted.keys.front().pose, scripted.local);
    for (std::size_t i = 0; i < scripted.vertices.size(); ++i) {
      setup.x.row(scripted.vertices[i]) = placed.row(static_cast<Eigen::Index>(i));
    }
  }
  return setup;
}

double mass_of(const StageSetup& setup, Eigen::Index vertex) {
  const double inverse_mass = setup.inverse_mass[static_cast<std::size_t>(vertex)];
  return inverse_mass > 0 ? 1 / inverse_mass : 0;
}

}  // namespace

Part StageSetup::add_part(const sim::Shape& shape, const Vec3& position_m) {
  const Part part{static_cast<VertexId>(x.rows()), static_cast<VertexId>(x.rows() + shape.x.rows())};
  x.conservativeResize(part.end, 3);
  x.bottomRows(part.size()) = shape.x.rowwise() + position_m.transpose();
  v.conservativeResize(part.end, 3);
  v.bottomRows(part.size()).setZero();
  for (const auto& t : shape.triangles) {
    triangles.push_back({t[0] + part.begin, t[1] + part.begin, t[2] + part.begin});
  }
  return part;
}

Part StageSetup::add_cloth(const sim::Shape& shape, const Vec3& position_m, const Material& material,
                           const Vec3& velocity_m_s) {
  const Part part = add_part(shape, position_m);
  v.bottomRows(part.size()).rowwise() = velocity_m_s.transpose();
  face_is_body.resize(triangles.size(), 0);
  inverse_mass.resize(static_cast<std::size_t>(part.end), 1 / material.vertex_mass_kg);
  body.resize(static_cast<std::size_t>(part.end), -1);
  sim::ClothSpec spec;
  spec.surface = sim::MeshSpec{};
  spec.stretch_n_m = material.stretch_n_m;
  spec.bend_n_m = material.bend_n_m;
  spec.damping_ratio = material.damping_ratio;
  const std::vector<double> mass_kg(static_cast<std::size_t>(part.size()), material.vertex_mass_kg);
  for (sim::Spring spring : sim::make_springs(spec, shape, mass_kg)) {
    spring.a += part.begin;
    spring.b += part.begin;
    springs.push_back(spring);
  }
  return part;
}

Part StageSetup::add_body(const sim::Shape& local, const std::vector<sim::PoseKey>& keys) {
  const Part part = add_part(local, Vec3::Zero());
  face_is_body.resize(triangles.size(), 1);
  inverse_mass.resize(static_cast<std::size_t>(part.end), 0);
  body.resize(static_cast<std::size_t>(part.end), static_cast<std::int32_t>(scripted.size()));
  std::vector<VertexId> vertices(static_cast<std::size_t>(part.size()));
  std::iota(vertices.begin(), vertices.end(), part.begin);
  scripted.push_back({std::move(vertices), local.x, keys});
  return part;
}

void StageSetup::pin(const std::vector<VertexId>& vertices, const std::vector<sim::PoseKey>& keys) {
  Positions local(static_cast<Eigen::Index>(vertices.size()), 3);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const auto vertex = static_cast<std::size_t>(vertices[i]);
    local.row(static_cast<Eigen::Index>(i)) = x.row(vertices[i]);
    inverse_mass[vertex] = 0;
    body[vertex] = static_cast<std::int32_t>(scripted.size());
  }
  scripted.push_back({vertices, std::move(local), keys});
}

Stage::Stage(Trial& trial, StageSetup setup)
    : trial_(trial),
      offset_(trial.offset(setup.length_m)),
      setup_(moved(std::move(setup), offset_)),
      mesh_(make_mesh(static_cast<std::int32_t>(setup_.x.rows()), setup_.triangles)),
      springs_(setup_.springs, mesh_.vertex_count),
      collision_step_(mesh_, setup_.collision),
      watch_(trial, setup_.triangles, setup_.face_is_body, mesh_.vertex_count, setup_.collision),
      x_(setup_.x),
      v_(setup_.v),
      x_start_(setup_.x) {
  sim::CentralDifferencesOptions options;
  options.fields.gravity_m_s2 = setup_.gravity_m_s2;
  options.fields.drag_1_s = setup_.drag_1_s;
  options.strain = setup_.strain;
  options.step_s = std::min(sim::kStableShare * sim::stable_step_s(springs_, setup_.inverse_mass), setup_.dt_s);
  dynamics_ = std::make_unique<sim::CentralDifferences>(springs_, options);
  for (const StageSetup::Scripted& scripted : setup_.scripted) {
    paths_.emplace_back(scripted.keys, sim::Interpolation::kLinear);
  }
  watch_.start(x_);
}

Positions Stage::candidate() {
  Positions target = x_;
  for (std::size_t s = 0; s < paths_.size(); ++s) {
    const StageSetup::Scripted& scripted = setup_.scripted[s];
    const Positions placed = sim::place(paths_[s].at(time_s() + setup_.dt_s), scripted.local);
    for (std::size_t i = 0; i < scripted.vertices.size(); ++i) {
      target.row(scripted.vertices[i]) = placed.row(static_cast<Eigen::Index>(i));
    }
  }
  end_ = {x_, v_};
  dynamics_->advance(end_, target, setup_.inverse_mass, setup_.dt_s);
  has_end_ = true;
  return end_.x;
}

const sim::CollisionStepReport& Stage::step_to(const Positions& candidate) {
  const sim::CollisionStepReport& report = try_step_to(candidate);
  trial_.require(report.status == sim::StepStatus::kSafe, "the step stopped, or called its input invalid");
  return report;
}

const sim::CollisionStepReport& Stage::try_step_to(const Positions& candidate) {
  sim::CollisionStepResult result =
      collision_step_(x_, candidate, {setup_.inverse_mass, setup_.body, setup_.policy}, setup_.dt_s);
  if (result.report.status == sim::StepStatus::kSafe) {
    watch_.step(x_, result.x, result.report);
    for (const StageSetup::Scripted& scripted : setup_.scripted) {
      const auto body = static_cast<std::int32_t>(&scripted - setup_.scripted.data());
      const bool waits = std::ranges::binary_search(result.report.waiting_bodies, body);
      for (const VertexId vertex : scripted.vertices) {
        trial_.require(result.x.row(vertex) == (waits ? x_ : candidate).row(vertex),
                       "a scripted vertex left its script");
      }
    }
    weigh(candidate, result);
    commit(result);
    ++step_count_;
  }
  has_end_ = false;
  report_ = std::move(result.report);
  return report_;
}

void Stage::weigh(const Positions& candidate, const sim::CollisionStepResult& result) {
  const bool scripts = std::ranges::count(setup_.inverse_mass, 0.0) > 0;
  if (scripts || result.report.fail_safe_vertices > 0 || result.report.cut_candidates > 0) return;
  const Positions before = (candidate - x_) / setup_.dt_s;
  Vec3 change = Vec3::Zero(), turn = Vec3::Zero();
  double size = 0, turn_size = 0, energy_before = 0, energy_after = 0, mass = 0;
  for (Eigen::Index i = 0; i < before.rows(); ++i) {
    const double m = mass_of(setup_, i);
    const Vec3 arm = (x_.row(i) - offset_.transpose()).transpose(), v0 = before.row(i), v1 = result.velocity.row(i);
    change += m * (v1 - v0);
    turn += m * arm.cross(v1 - v0);
    size += m * (v0.norm() + v1.norm());
    turn_size += m * arm.norm() * (v0.norm() + v1.norm());
    energy_before += m / 2 * v0.squaredNorm();
    energy_after += m / 2 * v1.squaredNorm();
    mass += m;
  }
  if (size == 0) return;
  momentum_error_ = std::max(momentum_error_, change.norm() / size);
  // A zone's chord keeps sin(angle) / angle of the angular momentum: docs/guarantee-step.md, S3.
  if (result.report.zone_rounds == 0) {
    angular_momentum_error_ = std::max(angular_momentum_error_, turn.norm() / turn_size);
  }
  const double push_m_s = 2 * setup_.collision.tolerance_m / setup_.dt_s;
  energy_gain_ =
      std::max(energy_gain_, (energy_after - energy_before - mass / 2 * push_m_s * push_m_s) / energy_before);
}

void Stage::commit(const sim::CollisionStepResult& result) {
  Positions scripted_v = (result.x - x_) / setup_.dt_s;
  x_ = result.x;
  if (result.report.touched() || !has_end_) {
    end_ = {x_, result.velocity};
    if (has_end_) dynamics_->final_velocity(end_, setup_.inverse_mass, setup_.dt_s);
  }
  v_ = end_.v;
  for (Eigen::Index i = 0; i < v_.rows(); ++i) {
    if (setup_.inverse_mass[static_cast<std::size_t>(i)] == 0) v_.row(i) = scripted_v.row(i);
  }
}

Vec3 Stage::centre(const Part& part) const {
  return x_.middleRows(part.begin, part.size()).colwise().mean().transpose() - offset_;
}

Vec3 Stage::mean_velocity(const Part& part) const {
  return v_.middleRows(part.begin, part.size()).colwise().mean().transpose();
}

double Stage::kinetic_energy_j() const {
  double sum = 0;
  for (Eigen::Index i = 0; i < v_.rows(); ++i) sum += mass_of(setup_, i) / 2 * v_.row(i).squaredNorm();
  return sum;
}

double Stage::energy_j() const {
  double sum = kinetic_energy_j();
  for (Eigen::Index i = 0; i < x_.rows(); ++i) {
    sum -= mass_of(setup_, i) * setup_.gravity_m_s2.dot((x_.row(i) - x_start_.row(i)).transpose());
  }
  for (const sim::Spring& spring : setup_.springs) sum += elastic_j(spring, x_);
  return sum;
}

double Stage::largest_strain() const {
  double largest = 0;
  for (const sim::Spring& spring : setup_.springs) {
    if (spring.kind == sim::SpringKind::kBending) continue;
    largest = std::max(largest, std::abs(elongation(spring, x_)));
  }
  return largest;
}

void Stage::require_balances() {
  trial_.at_most("momentum error", momentum_error_, 1e-9);
  trial_.at_most("angular momentum error", angular_momentum_error_, 1e-9);
  trial_.at_most("energy gained by contact", energy_gain_, 1e-9);
}

}  // namespace selvage::bench
