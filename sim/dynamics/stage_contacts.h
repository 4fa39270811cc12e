// Contacts within an implicit stage: the springs feel them at once. Left to the end of a step as long as the implicit
// solver's, contact moves vertices of stiff springs against all others, and strains them by more energy than moves.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/base/conjugate_gradients.h"
#include "sim/dynamics/held_contacts.h"

namespace selvage::sim {

/// An internal step of a collision step, from share_t0 to share_t1 of it.
struct StageSpan {
  double share_t0 = 0, share_t1 = 1, h_s = 0;
};

/// What contacts bear, as what it would move the pair alone by: weights on light cloth count as much as blows on heavy
/// cloth.
struct ForceChange {
  double change_m = 0;   ///< the largest change of a force
  double largest_m = 0;  ///< the largest force along the normal

  /// Of the change in the largest of all; none where it is less than positions are known to.
  [[nodiscard]] double share(double known_m) const {
    return change_m > known_m ? change_m / std::max(change_m, largest_m) : 0;
  }
};

/// The conditions distance >= min(thickness, distance at the start), with Coulomb's friction, as terms of the stage's
/// potential (implicit_stage.h), by augmented Lagrangians (Nocedal and Wright 2006, 17.3; for friction Alart and
/// Curnier 1991): with a gap g above what is allowed and a slip s, both linear in the displacements u, a contact adds
///   max(0, p - k g)^2 / 2k + (the same for s of a force q - k s that is cut at the cone's radius),
/// where p and q, what it bears, are found by solving the stage a few times. Directions and points are those of the
/// contact at the start of the collision step. The potential is convex, and in the first span, beside bodies at rest,
/// no more at the start than what the contact bore before makes it: from there no step gains energy by it. Forces are
/// opposite within a pair, and along its normal or without a torque on it. Masses stand for forces, kg m, as in the
/// whole potential.
class StageContacts : public Coupling {
 public:
  /// For cloth at x, m, at the start of the span. `resistance_kg`: a bound of the diagonal of the stage's matrix at
  /// each vertex of the cloth. Contacts with a limited lever (interaction.h) are left to the collision step. Takes the
  /// loads of all. `held` must outlive it.
  StageContacts(HeldContacts& held, const Positions& x, std::span<const double> inverse_mass,
                std::span<const double> resistance_kg, const StageSpan& span);

  /// Looks at the displacements u, m: all below is for these. O(contacts), in parallel, as all of them.
  void look(const Positions& u);
  /// On a vertex, kg m.
  [[nodiscard]] Eigen::RowVector3d force_at(Eigen::Index vertex) const;
  /// Second derivatives.
  void add_product(const LaneVectors& step, LaneVectors& result) const override;
  void add_diagonal(Eigen::Index vertex, SymmetricBlock& block) const override;
  /// What `step` changes in each contact's potential, one number each.
  void changes(const Positions& step, double share, std::vector<double>& terms) const;

  /// Takes what was found for what the contacts bear.
  ForceChange update();
  /// After the forces were found: contacts at the border of the static cone slide from now on. Whether that changes
  /// what one bears by more than known_m, as in ForceChange. Asked before, forces that are not found yet, or cones that
  /// open with them, had cloth slide that sticks.
  bool let_slide(double known_m);
  /// To begin again without what they bore before. False where that is what they began with: nothing, or forgotten.
  bool forget();
  /// Tells the contacts what they bore.
  void finish();

 private:
  struct Term {
    std::size_t held = 0;
    std::array<VertexId, 4> vertices{};              ///< -1 where not cloth
    Eigen::Matrix3d axes = Eigen::Matrix3d::Zero();  ///< rows: the normal, and two across it where there is friction
    std::array<Eigen::Matrix3d, 4> jacobian;         ///< of gap and slip by the displacements, along the axes
    Vec3 start = Vec3::Zero();                       ///< gap and slip where no cloth moves, m
    double stiffness_kg = 0, mobility_1_kg = 0;
    double friction_static = 0, friction_kinetic = 0;
    bool is_at_border = false, slides = false;
    Vec3 borne = Vec3::Zero();  ///< p and q, kg m
    // At the displacements looked at: what gap and slip ask for, what they get, and its derivative.
    Vec3 asked = Vec3::Zero(), force = Vec3::Zero();
    Eigen::Matrix3d curvature = Eigen::Matrix3d::Zero();

    [[nodiscard]] double radius() const { return (slides ? friction_kinetic : friction_static) * borne[0]; }
  };

  /// A contact as one of its vertices sees it.
  struct End {
    std::uint32_t term;
    Eigen::Matrix3d jacobian;
  };

  void add_term(std::size_t held_id, const Positions& x, std::span<const double> inverse_mass,
                std::span<const double> resistance_kg);
  void index_ends(Eigen::Index vertex_count);
  [[nodiscard]] std::span<const End> ends_at(Eigen::Index vertex) const;
  template <class Vectors>
  [[nodiscard]] static Vec3 moved(const Term& term, const Vectors& u);

  HeldContacts& held_;
  StageSpan span_;
  std::vector<Term> terms_;
  bool remembers_ = false;          ///< some began with what they bore before
  std::vector<std::size_t> begin_;  ///< the ends at vertex i are ends_[begin_[i] .. begin_[i + 1])
  std::vector<End> ends_;
  enum class Acts : std::uint8_t { kNot, kAlongNormal, kAcross };
  std::vector<Acts> acts_;              ///< of the terms
  mutable std::vector<Vec3> response_;  ///< room for add_product()
};

}  // namespace selvage::sim
