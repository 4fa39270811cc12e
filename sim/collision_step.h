// The collision step as one function for any simulator: an intersection-free state, candidate positions, and masses go
// in; positions come out whose straight motion from the state is certified free of touching (S1). Paper, section 7.
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "kernel/kernel.h"
#include "sim/base/blockage.h"
#include "sim/base/phase_times.h"
#include "sim/contact/collision_bodies.h"
#include "sim/contact/collision_options.h"
#include "sim/contact/contact_surfaces.h"
#include "sim/contact/repulsion_contact.h"

namespace selvage::sim {

class ContactTable;

/// When to give a step up, because the caller tries a shorter one then (paper, section 5). By default never.
struct Patience {
  static constexpr std::int64_t kEndless = std::numeric_limits<std::int64_t>::max();
  std::int64_t collisions = kEndless;      ///< give up where the repulsions leave more of them than this
  std::int64_t impulse_rounds = kEndless;  ///< give up where one is left after so many rounds, or the last there may be
};

enum class StepStatus : std::uint8_t {
  kSafe,         ///< S1 holds for the returned positions
  kStopped,      ///< no safe positions were found under the policy; the returned positions are V_t0
  kAbandoned,    ///< the caller's Patience ended; the returned positions are V_t0
  kInvalidInput  ///< NaN, sizes, domain: nothing was done; the returned positions are V_t0. input_error says what is
                 ///< wrong, and of kBadOption first_bad_option() (step_input.h) which one
};
[[nodiscard]] std::string_view name_of(StepStatus status);

struct CollisionStepReport {
  StepStatus status = StepStatus::kInvalidInput;
  InputError input_error = InputError::kNone;
  /// Candidates of cloth that were cut back before anything else, as the simulation has blown up:
  /// those farther from their start than 1024 diagonals of the scene's box, or all, by powers of two, where more than
  /// 64 pairs a vertex, and than 16,384, would collide, or come within a tolerance that is not long beside the edges.
  std::int64_t cut_candidates = 0;
  /// Contacts that are held, and other pairs that are near at the start and approaching (StartProximities::count()).
  std::int64_t proximities = 0;
  std::int64_t repulsions = 0, frictions = 0;
  /// Left by the repulsions, before any impulse of section 7.4; at least so many where the step was abandoned.
  std::int64_t first_collisions = 0;
  std::int32_t impulse_rounds = 0, zone_rounds = 0, fail_safe_rounds = 0;
  std::int32_t largest_zone = 0;        ///< vertices
  std::int64_t fail_safe_vertices = 0;  ///< 0 in ordinary scenes
  /// Sorted: vertices of cloth that had no room. Those of impact zones, those that the fail-safe held back, and those
  /// of collisions for which bodies had to wait; of all tries where these had to.
  std::vector<VertexId> without_room;
  /// Where the time went, of all tries where bodies had to wait; the counts are of the last. Differs from run to run.
  CollisionPhases phases;
  std::vector<std::int32_t> waiting_bodies;  ///< sorted; -1: the scripted vertices that belong to no body
  std::vector<VertexId> waiting_vertices;    ///< sorted; theirs: all, or some where they deform
  /// What bodies had to wait for, or the step had to stop for, as far as it is known: of all tries.
  std::vector<Blockage> blockages;
  std::vector<Collision> below_tolerance;  ///< free of touch, but not proved farther than tolerance at the end (S2)
  /// Those of them in which nothing moved, and which cannot be told from touching: free of touch because V_t0 is, at
  /// which the step does not look. Not 0 where V_t0 touches, against PRE, or comes within rounding of that: ask
  /// verify::check_frame, which names all that intersects.
  std::int64_t trusted_pairs = 0;
  std::optional<Collision> witness;  ///< for kStopped
  /// Of x: the pairs not proved separated (those of below_tolerance), and the queries of all rounds. A pair is asked
  /// again only after one of its vertices changed, so each answer is for the motion V_t0 -> x.
  CollisionReport certificate;

  /// Whether repulsions left something to resolve.
  [[nodiscard]] bool collided() const { return impulse_rounds + zone_rounds + fail_safe_rounds > 0; }
  /// Whether anything met.
  [[nodiscard]] bool touched() const { return repulsions + frictions > 0 || collided(); }
};

struct CollisionStepResult {
  Positions x;  ///< #V by 3: certified where the status is kSafe, else V_t0; exactly the doubles to store
  /// #V by 3, m/s: the average velocity (x - V_t0) / dt after impulses, before rounding to x; at most the largest
  /// finite double. Impulses keep momentum and angular momentum, but for `held` contacts whose normal is not the line
  /// of their points at V_t0, which keep the first alone; a zone that turns by an angle in the step is at the end of a
  /// chord, which keeps sin(angle) / angle of the latter about its axis (docs/guarantee-step.md).
  Positions velocity;
  /// Contacts beside `held` that pressed, and collisions that repulsions left, as contacts: dynamics that hold contacts
  /// should know of them in another try from the same V_t0. None without repulsion.
  std::vector<RepulsionContact> met;
  CollisionStepReport report;
};

/// Holds what persists between steps: connectivity, hierarchy, and the near pairs at the last V_t0, which a second try
/// from the same positions needs again. None of it changes a result. One call at a time: where another thread's has not
/// returned a step answers kInvalidInput (kInUse), and find_contacts() nothing. Different objects are independent. A
/// call may throw std::bad_alloc, after which the object is as good as before.
class CollisionStep {
 public:
  /// The mesh must outlive it. With `surfaces` each pair has the thickness, tolerance and friction of its two surfaces
  /// (combine()), and those of the options are not used; its rest pairs repel below their distances at rest. Surfaces
  /// that do not fit the mesh, or have a value out of its range, are called invalid by every step.
  CollisionStep(const Mesh& mesh, const CollisionOptions& options, ContactSurfaces surfaces = {});
  CollisionStep(const Mesh&&, const CollisionOptions&, ContactSurfaces = {}) = delete;
  ~CollisionStep();
  /// What was moved from may be assigned to or destroyed, and nothing else.
  CollisionStep(CollisionStep&&) noexcept;
  CollisionStep& operator=(CollisionStep&&) noexcept;

  /// From V_t0 towards V_candidate, both #V by 3; dt_s: finite, > 0. Scripted vertices' candidates are their script.
  /// PRE: V_t0 is exactly free of intersections. Two features of bodies are not looked at and may intersect; a body is
  ///   a part of the mesh in which every vertex has a body that is no pin. The step does not check this: of a V_t0 that
  ///   intersects nothing is promised, and what is through stays through (verify::check_frame is for the first; each
  ///   kSafe x is free again). With kFloat32 V_t0 lies on the lattice.
  /// POST (kSafe): the straight motion V_t0 -> x is exactly free of touching. What is nearer than its tolerance is
  ///   named. Scripted vertices are at their candidates, or at V_t0 where they wait. All are within kMaxCoordinate.
  ///   With kFloat32 x lies on the lattice, within the largest float32, and scripted vertices are at their candidates
  ///   rounded to it; of a script beyond that the input is invalid (kTooLarge).
  /// COST: at most (bodies + vertices of those that deform + 2) (max_impulse_rounds + max_zone_rounds + 3 #V + 16)
  ///   searches for collisions, of which an ordinary step needs a few. The same bits for any number of threads.
  [[nodiscard]] CollisionStepResult operator()(const PositionsRef& V_t0, const PositionsRef& V_candidate,
                                               const CollisionBodies& bodies, double dt_s,
                                               const Patience& patience = {},
                                               std::span<const RepulsionContact> held = {});

  /// For dynamics that hold contacts, as those of the explicit and the implicit solver do: those that a motion from
  /// V_t0 to V_candidate would press, to be given back as `held` for a step from the same V_t0, in which they repel
  /// like all others where something is left, but for those beyond what is straight (straight_surface.h). Those that
  /// rest, too: which a fall by `fall`, m, of one of the two alone would press, and of `pressed` all that are near.
  /// REQUIRES valid arguments, as above; with an invalid one there is none. Time and memory grow with the pairs within
  /// reach (contact_reach.h), as of a step: O(n log n) where edges are not much shorter than that, all pairs of a mesh
  /// that is smaller than its cloth is thick. A step from the same V_t0 need not look for near pairs again.
  [[nodiscard]] std::vector<RepulsionContact> find_contacts(const PositionsRef& V_t0, const PositionsRef& V_candidate,
                                                            const CollisionBodies& bodies,
                                                            const Vec3& fall = Vec3::Zero(),
                                                            const Candidates& pressed = {});

  /// Thickness, tolerance and friction of every pair.
  [[nodiscard]] const ContactTable& contact_table() const;
  /// The faces around every vertex.
  [[nodiscard]] const VertexFaces& vertex_faces() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace selvage::sim
