// The collision step as one function for any simulator: an intersection-free state, candidate positions, and masses go
// in; positions come out whose straight motion from the state is certified free of touching (S1). Paper, section 7.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kernel/kernel.h"
#include "sim/contact_properties.h"
#include "sim/phase_times.h"
#include "sim/repulsion_contact.h"

namespace selvage::sim {

class ContactTable;

/// Defaults are the paper's numbers, except for `relaxation`. The first two and the friction are those of the whole
/// mesh, unless ContactSurfaces says what its parts have.
struct CollisionOptions {
  double thickness_m = 1e-3;           ///< cloth thickness h: repulsions act below it (paper, 7.2); >= 0
  double tolerance_m = 1e-6;           ///< distance kept at the end of every step (paper, section 6); >= 0
  double repulsion_stiffness_n_m = 0;  ///< spring constant k of the overlap repulsion; 0: the inelastic part alone
  double overlap_fraction = 0.1;       ///< of the overlap removed a step at most (paper, 7.2), in [0, 1]
  /// An impulse of section 7.4 gives at most this share of itself in one parallel round, in (0, 1]; never more than
  /// 1 / number of pairs at a vertex, which is what keeps energy from growing. The paper names both remedies and 0.25
  /// (7.2, 7.4); with the second the first only costs rounds.
  double relaxation = 1;
  double friction_static = 0;            ///< Coulomb coefficient, dimensionless, >= friction_kinetic
  double friction_kinetic = 0;           ///< Coulomb coefficient, dimensionless, >= 0
  bool repulsion = true;                 ///< section 7.2 and 7.3 at all
  std::int32_t impulse_iterations = 10;  ///< rounds of section 7.4 before impact zones, >= 0
  std::int32_t zone_iterations = 20;     ///< rounds of section 7.5 before the fail-safe, >= 0
  enum class Precision { kFloat64, kFloat32 } precision = Precision::kFloat64;  ///< lattice that the result lies on
  std::int32_t max_intervals = 4096;                                            ///< CcdOptions::max_intervals, >= 1
};

/// The part of the options that ContactSurfaces replaces.
[[nodiscard]] ContactProperties contact_of(const CollisionOptions& options);

/// What to do where cloth cannot avoid scripted bodies (S4).
enum class SqueezePolicy : std::uint8_t {
  kStop,   ///< return kStopped with a witness; nothing is advanced
  kYield,  ///< the bodies involved wait, or the vertices involved of those that deform: they keep their positions for
           ///< this step
};

struct CollisionBodies {
  /// #V: inverse masses in 1/kg; 0 for scripted vertices, which follow their candidate positions exactly.
  std::span<const double> inverse_mass;
  /// #V: body that a scripted vertex belongs to, -1 for cloth. A body moves, or waits, as a whole. Empty: no bodies.
  std::span<const std::int32_t> body = {};
  SqueezePolicy policy = SqueezePolicy::kStop;
  /// The bodies from this one on are pins: what they hold is cloth, even a part of the mesh of which they hold all.
  std::int32_t first_pin = std::numeric_limits<std::int32_t>::max();
  /// By body, shorter where the others do not: 1 where its motion is no rigid one. It waits vertex by vertex, and cloth
  /// that has to move with it moves with what it meets.
  std::span<const std::uint8_t> deforms = {};
};

/// When to give a step up, because the caller tries a shorter one then (paper, section 5). By default never.
struct Patience {
  static constexpr std::int64_t kEndless = std::numeric_limits<std::int64_t>::max();
  std::int64_t collisions = kEndless;      ///< where the repulsions leave more than so many
  std::int64_t impulse_rounds = kEndless;  ///< where impulses leave one after so many rounds, or after all they have
};

enum class StepStatus : std::uint8_t {
  kSafe,         ///< S1 holds for the returned positions
  kStopped,      ///< no safe positions were found under the policy; the returned positions are V_t0
  kAbandoned,    ///< the caller's Patience ended; the returned positions are V_t0
  kInvalidInput  ///< NaN, sizes, domain (input_error says which): nothing was done; the returned positions are V_t0
};
[[nodiscard]] std::string_view name_of(StepStatus status);

struct CollisionStepReport {
  StepStatus status = StepStatus::kInvalidInput;
  InputError input_error = InputError::kNone;
  /// Candidates of cloth that were farther from their start than 1024 diagonals of the scene's box, and were cut back
  /// to that before anything else (travel_limit.h): the simulation has blown up.
  std::int64_t cut_candidates = 0;
  /// Contacts that are held, and other pairs that are near at the start and approaching (StartProximities::count()).
  std::int64_t proximities = 0;
  std::int64_t repulsions = 0, frictions = 0;
  std::int64_t first_collisions = 0;  ///< left by the repulsions, before any impulse of section 7.4
  std::int32_t impulse_rounds = 0, zone_rounds = 0, fail_safe_rounds = 0;
  std::int32_t largest_zone = 0;             ///< vertices
  std::int64_t fail_safe_vertices = 0;       ///< 0 in ordinary scenes
  CollisionPhases phases;                    ///< where the time went; differs from run to run
  std::vector<std::int32_t> waiting_bodies;  ///< sorted; -1: the scripted vertices that belong to no body
  std::vector<VertexId> waiting_vertices;    ///< sorted; theirs: all, or some where they deform
  std::vector<Collision> below_tolerance;    ///< free of touch, but not proved farther than tolerance at the end (S2)
  std::optional<Collision> witness;          ///< for kStopped
  /// Of x: the pairs not proved separated (those of below_tolerance), and the queries of all rounds. A pair is asked
  /// again only after one of its vertices changed, so each answer is for the motion V_t0 -> x.
  CollisionReport certificate;
};

struct CollisionStepResult {
  Positions x;  ///< #V by 3: certified where the status is kSafe, else V_t0; exactly the doubles to store
  /// #V by 3, m/s: the average velocity (x - V_t0) / dt after impulses, before rounding to x; at most the largest
  /// finite double.
  Positions velocity;
  /// Contacts beside `held` that pressed, and collisions that repulsions left, as contacts: dynamics that hold contacts
  /// should know of them in another try from the same V_t0. None without repulsion.
  std::vector<RepulsionContact> met;
  CollisionStepReport report;
};

/// Holds what persists between steps: connectivity, hierarchy, and the near pairs at the last V_t0, which a second try
/// from the same positions needs again. None of it changes a result.
class CollisionStep {
 public:
  /// The mesh must outlive it. With `surfaces` each pair has the thickness, tolerance and friction of its two surfaces
  /// (combine()), and those of the options are not used; its rest pairs repel below their distances at rest. Surfaces
  /// that do not fit the mesh, or have a value out of its range, are called invalid by every step.
  CollisionStep(const Mesh& mesh, const CollisionOptions& options, ContactSurfaces surfaces = {});
  CollisionStep(const Mesh&&, const CollisionOptions&, ContactSurfaces = {}) = delete;
  ~CollisionStep();
  CollisionStep(CollisionStep&&) noexcept;

  /// PRE: V_t0 is free of intersections (exactly), bodies among themselves excepted: two features of bodies are not
  /// looked at (a part of the mesh in which every vertex has a body that is no pin is one). V_candidate: any finite
  /// positions; scripted vertices' are their script. With kFloat32 V_t0 lies on the lattice, and the candidates, the
  /// scripts' too, are rounded to it; a script beyond the largest float32 is invalid (kTooLarge). POST (kSafe): the
  /// straight motion V_t0 -> x is exactly free of touching; what is nearer than its tolerance is named; scripted
  /// vertices are at their (rounded) candidates, or at V_t0 where they wait; all others are within
  /// kMaxCoordinate, or the largest float32. Ends after at most (bodies + vertices of those that deform + 2)
  /// (impulse_iterations + zone_iterations + 3 #V + 1) searches for collisions. Deterministic for any thread count.
  [[nodiscard]] CollisionStepResult operator()(const PositionsRef& V_t0, const PositionsRef& V_candidate,
                                               const CollisionBodies& bodies, double dt_s,
                                               const Patience& patience = {},
                                               std::span<const RepulsionContact> held = {});

  /// For dynamics that hold contacts (held_contacts.h): those that a motion from V_t0 to V_candidate would press, to be
  /// given back as `held` for a step from the same V_t0, in which they repel like all others where something is left.
  /// Those that rest, too: which a fall by `fall`, m, of one of the two alone would press. REQUIRES valid arguments, as
  /// above; with an invalid one there is none. Time and memory grow with the pairs nearer than a thickness, as of a
  /// step: O(n log n) where edges are not much shorter than that, all pairs of a mesh that is smaller than its cloth is
  /// thick. A step from the same V_t0 need not look for near pairs again.
  [[nodiscard]] std::vector<RepulsionContact> find_contacts(const PositionsRef& V_t0, const PositionsRef& V_candidate,
                                                            const CollisionBodies& bodies,
                                                            const Vec3& fall = Vec3::Zero());

  /// Of the mesh and its surfaces.
  [[nodiscard]] const ContactTable& contact_table() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace selvage::sim
