// Pieces of cloth and scripted bodies around one CollisionStep: what another simulator would write, with every step
// checked exactly.
#pragma once

#include <memory>
#include <vector>

#include "bench/stability/exact_watch.h"
#include "bench/stability/trial.h"
#include "sim/collision_step.h"
#include "sim/dynamics/central_differences.h"
#include "sim/scene/rigid_path.h"
#include "sim/scene/shapes.h"

namespace selvage::bench {

/// Rows of the positions, [begin, end).
struct Part {
  VertexId begin = 0, end = 0;
  [[nodiscard]] Eigen::Index size() const { return end - begin; }
};

/// Springs along the edges of the mesh; none where the stiffness is 0.
struct Material {
  double vertex_mass_kg = 1e-3;
  double stretch_n_m = 0, bend_n_m = 0, damping_ratio = 0;
};

struct StageSetup {
  Part add_cloth(const sim::Shape& shape, const Vec3& position_m, const Material& material = {},
                 const Vec3& velocity_m_s = Vec3::Zero());
  /// A rigid body that follows the keys, linear between them.
  Part add_body(const sim::Shape& local, const std::vector<sim::PoseKey>& keys);
  Part add_body(const sim::Shape& local, const Vec3& position_m) { return add_body(local, {{0, {position_m}}}); }
  /// Cloth vertices that follow a rigid motion, which turns about the origin, instead of the dynamics.
  void pin(const std::vector<VertexId>& vertices, const std::vector<sim::PoseKey>& keys);

  /// Follows a script; the path's first key is where it starts.
  struct Scripted {
    std::vector<VertexId> vertices;
    Positions local;
    std::vector<sim::PoseKey> keys;
  };

  Positions x{0, 3}, v{0, 3};
  io::Triangles triangles;
  std::vector<std::uint8_t> face_is_body;
  std::vector<double> inverse_mass;
  std::vector<std::int32_t> body;
  std::vector<sim::Spring> springs;
  std::vector<Scripted> scripted;
  sim::CollisionOptions collision;
  sim::SqueezePolicy policy = sim::SqueezePolicy::kStop;
  sim::StrainLimits strain;
  Vec3 gravity_m_s2 = Vec3::Zero();
  double drag_1_s = 0;
  double dt_s = 0.01;
  double length_m = 1;  ///< of which a million are the far offset

 private:
  Part add_part(const sim::Shape& shape, const Vec3& position_m);
};

class Stage {
 public:
  /// Moves everything by the trial's offset, and requires that the start is free of intersections.
  Stage(Trial& trial, StageSetup setup);

  /// Where the dynamics and the scripts would take it in one step.
  [[nodiscard]] Positions candidate();
  /// One step of the dynamics.
  const sim::CollisionStepReport& step() { return step_to(candidate()); }
  /// One step towards these positions, whatever the dynamics says; the velocity becomes what the step returns.
  const sim::CollisionStepReport& step_to(const Positions& candidate);
  /// A step that may end in any status: checked where it is safe, and then taken.
  const sim::CollisionStepReport& try_step_to(const Positions& candidate);

  [[nodiscard]] const Positions& x() const { return x_; }
  [[nodiscard]] const Positions& v() const { return v_; }
  [[nodiscard]] Positions& v() { return v_; }
  [[nodiscard]] const StageSetup& setup() const { return setup_; }
  [[nodiscard]] double time_s() const { return static_cast<double>(step_count_) * setup_.dt_s; }
  [[nodiscard]] const Vec3& offset() const { return offset_; }

  [[nodiscard]] Vec3 centre(const Part& part) const;
  [[nodiscard]] Vec3 mean_velocity(const Part& part) const;
  [[nodiscard]] double kinetic_energy_j() const;
  /// Kinetic, of gravity (0 at the start) and elastic.
  [[nodiscard]] double energy_j() const;
  /// Of springs that have a strain limit, relative to their length at rest.
  [[nodiscard]] double largest_strain() const;

  /// Records what S3 promises as figures, over all steps without a script, the fail-safe or a cut candidate: changes of
  /// momentum and angular momentum by contact at most 1e-9 of their sizes, energy gained by contact at most 1e-9 and
  /// what pushing pairs to the tolerance may give.
  void require_balances();

 private:
  void weigh(const Positions& candidate, const sim::CollisionStepResult& result);
  void commit(const sim::CollisionStepResult& result);

  Trial& trial_;
  Vec3 offset_;  // before setup_, which is moved by it
  StageSetup setup_;
  Mesh mesh_;
  sim::SpringSystem springs_;
  std::unique_ptr<sim::CentralDifferences> dynamics_;
  sim::CollisionStep collision_step_;
  ExactWatch watch_;
  std::vector<sim::RigidPath> paths_;
  Positions x_, v_, x_start_;
  sim::Motion end_;  ///< of the last candidate()
  bool has_end_ = false;
  sim::CollisionStepReport report_;
  std::int64_t step_count_ = 0;
  double momentum_error_ = 0, angular_momentum_error_ = 0, energy_gain_ = 0;
};

}  // namespace selvage::bench
