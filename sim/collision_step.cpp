#include "sim/collision_step.h"

#include <algorithm>
#include <atomic>
#include <iterator>
#include <limits>
#include <utility>

#include "kernel/assert.h"
#include "kernel/fp_env.h"
#include "sim/base/sorted_once.h"
#include "sim/collision_attempt.h"
#include "sim/step_input.h"

namespace selvage::sim {
namespace {

/// Whether a call is alone with what persists.
class ExclusiveUse {
 public:
  explicit ExclusiveUse(std::atomic_flag& flag)
      : flag_(flag), is_first_(!flag.test_and_set(std::memory_order_acquire)) {}
  ~ExclusiveUse() {
    if (is_first_) flag_.clear(std::memory_order_release);
  }
  ExclusiveUse(const ExclusiveUse&) = delete;
  ExclusiveUse& operator=(const ExclusiveUse&) = delete;
  [[nodiscard]] bool is_first() const { return is_first_; }

 private:
  std::atomic_flag& flag_;
  const bool is_first_;
};

/// displacement / dt, at the largest finite double where that overflows.
Positions average_velocity(const Positions& displacement, double dt_s) {
  static constexpr double kMax = std::numeric_limits<double>::max();
  return displacement.unaryExpr([dt_s](double d) { return std::clamp(d / dt_s, -kMax, kMax); });
}

}  // namespace

std::string_view name_of(StepStatus status) {
  switch (status) {
    case StepStatus::kSafe:
      return "safe";
    case StepStatus::kStopped:
      return "stopped";
    case StepStatus::kAbandoned:
      return "abandoned";
    case StepStatus::kInvalidInput:
      break;
  }
  return "called invalid";
}

struct CollisionStep::Impl : StepContext {
  using StepContext::StepContext;
};

CollisionStep::CollisionStep(const Mesh& mesh, const CollisionOptions& options, ContactSurfaces surfaces)
    : impl_(std::make_unique<Impl>(mesh, options, std::move(surfaces))) {}
CollisionStep::~CollisionStep() = default;
CollisionStep::CollisionStep(CollisionStep&&) noexcept = default;
CollisionStep& CollisionStep::operator=(CollisionStep&&) noexcept = default;

const VertexFaces& CollisionStep::vertex_faces() const {
  SELVAGE_REQUIRE(impl_ != nullptr);
  return impl_->faces;
}

const ContactTable& CollisionStep::contact_table() const {
  SELVAGE_REQUIRE(impl_ != nullptr);
  return impl_->contacts;
}

CollisionStepResult CollisionStep::operator()(const PositionsRef& V_t0, const PositionsRef& V_candidate,
                                              const CollisionBodies& bodies, double dt_s, const Patience& patience,
                                              std::span<const RepulsionContact> held) {
  const FpEnvGuard guard;
  SELVAGE_REQUIRE(impl_ != nullptr);
  CollisionStepResult result{V_t0, Positions::Zero(V_t0.rows(), 3), {}, {}};
  const ExclusiveUse use(impl_->in_use);
  if (!use.is_first()) {
    result.report.input_error = InputError::kInUse;
    return result;
  }
  result.report.input_error = validate_step_input(impl_->mesh, impl_->options, V_t0, V_candidate, bodies, dt_s);
  if (result.report.input_error == InputError::kNone) result.report.input_error = impl_->contacts.error();
  if (result.report.input_error == InputError::kNone) result.report.input_error = validate_held(impl_->mesh, held);
  if (result.report.input_error != InputError::kNone) return result;

  ScriptedGroups groups(bodies);
  CollisionAttempt attempt(*impl_, bodies, groups, dt_s, patience, held);
  std::vector<Blockage> blockages;
  while (const auto conflict = attempt.run(V_t0, V_candidate)) {
    std::ranges::copy(conflict->blockages, std::back_inserter(blockages));
    if (bodies.policy == SqueezePolicy::kStop) break;
    groups.wait(conflict->groups, conflict->vertices);  // of which one at least moved till now: so this ends
  }

  result.report = std::move(attempt.report());
  result.met = std::move(attempt.met());
  result.report.waiting_bodies = groups.waiting_bodies();
  result.report.waiting_vertices = groups.waiting_vertices();
  result.report.blockages = std::move(blockages);
  result.report.without_room = std::move(attempt.without_room());
  keep_sorted_once(result.report.without_room);
  if (result.report.status != StepStatus::kSafe) return result;
  // What is not finite was not certified, whatever the tracker says.
  SELVAGE_ASSERT(attempt.motion().x().allFinite());
  result.report.certificate = attempt.tracker().report();
  result.report.below_tolerance = attempt.tracker().collisions();
  result.report.trusted_pairs = attempt.tracker().trusted(attempt.motion());
  result.x = attempt.motion().x();
  result.velocity = average_velocity(attempt.motion().displacement(), dt_s);
  return result;
}

std::vector<RepulsionContact> CollisionStep::find_contacts(const PositionsRef& V_t0, const PositionsRef& V_candidate,
                                                           const CollisionBodies& bodies, const Vec3& fall,
                                                           const Candidates& pressed) {
  const FpEnvGuard guard;
  SELVAGE_REQUIRE(impl_ != nullptr);
  Impl& impl = *impl_;
  const ExclusiveUse use(impl.in_use);
  if (!use.is_first() || !impl.options.repulsion || impl.contacts.error() != InputError::kNone) return {};
  if (validate_step_input(impl.mesh, impl.options, V_t0, V_candidate, bodies, 1) != InputError::kNone) return {};
  const std::vector<std::uint8_t> surface = impl.parts.cloth_flags(bodies);
  impl.proximities.start(impl.hierarchy, V_t0, surface);
  impl.straight.start(V_t0);
  const std::vector<PairProximity> near = impl.proximities.find(V_candidate, fall, pressed);
  const auto contacts = make_contacts(near, V_t0, bodies.inverse_mass, surface, impl);
  return {contacts.begin(), contacts.end()};
}

}  // namespace selvage::sim
