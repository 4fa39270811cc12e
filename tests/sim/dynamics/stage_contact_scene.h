// One contact as a stage of the implicit solver has it.
#pragma once

#include <vector>

#include "sim/dynamics/stage_contacts.h"
#include "tests/property.h"
#include "tests/sim/mechanics.h"

namespace selvage::sim::testbed {

inline constexpr double kStageThickness = 0.25, kStageStep = 0.125;

/// How bodies move in the collision step, and the part of it that the stage is.
struct StageMotion {
  Vec3 bodies = Vec3::Zero();  ///< m, in all of the collision step
  StageSpan span{0, 1, kStageStep};
  Vec3 cloth_before = Vec3::Zero();  ///< m, before the span
};

/// One contact of four vertices, of which the first `cloth_count` are cloth, and what a stage adds for it.
struct OneStageContact {
  Mesh mesh = make_mesh(4, Faces{{1, 2, 3}});
  SurfaceParts parts{mesh};
  VertexFaces faces{mesh};
  ContactTable properties{mesh, {}, {}};
  std::vector<double> inverse_mass, resistance_kg;
  Positions x, x_t1, cloth_x;
  HeldContacts held;
  StageContacts stage;

  OneStageContact(const RandomPair& pair, Eigen::Index cloth_count, double friction, double load_m_s2,
                  bool is_beyond = false)
      : OneStageContact(pair, cloth_count, friction, ContactLoads{{{0, 0, load_m_s2}}, {}}, is_beyond) {}
  OneStageContact(const RandomPair& pair, Eigen::Index cloth_count, double friction, const ContactLoads& loads,
                  bool is_beyond = false)
      : OneStageContact(pair, cloth_count, contact(pair, friction, is_beyond), loads, {}) {}
  OneStageContact(const RandomPair& pair, Eigen::Index cloth_count, const RepulsionContact& contact,
                  const ContactLoads& loads, const StageMotion& motion)
      : inverse_mass(pair.inverse_mass.begin(), pair.inverse_mass.end()),
        resistance_kg(resistances(pair)),
        x(rows(pair.x_t0)),
        x_t1(x.rowwise() + motion.bodies.transpose()),
        cloth_x(x.topRows(cloth_count).rowwise() + motion.cloth_before.transpose()),
        held({contact}, loads, HeldSurface{mesh, parts, faces, properties, inverse_mass, cloth_count, -Vec3::UnitZ()},
             x, x_t1, kStageStep, 1),
        stage(held, cloth_x, inverse_mass, resistance_kg, motion.span) {}

  static std::vector<double> resistances(const RandomPair& pair) {
    std::vector<double> result;
    for (const double w : pair.inverse_mass) result.push_back(w > 0 ? 2 / w : 1);
    return result;
  }
  static Positions rows(const PairVectors& vectors) {
    Positions result(4, 3);
    for (Eigen::Index i = 0; i < 4; ++i) result.row(i) = vectors[static_cast<std::size_t>(i)];
    return result;
  }
  static RepulsionContact contact(const RandomPair& pair, double friction, bool is_beyond = false) {
    RepulsionContact result = contact_of(pair, kStageThickness);
    result.is_beyond = is_beyond;
    result.properties.friction_static = result.properties.friction_kinetic = friction;
    return result;
  }
  [[nodiscard]] Positions forces(const Positions& u) {
    stage.look(u);
    Positions result(u.rows(), 3);
    for (Eigen::Index i = 0; i < u.rows(); ++i) result.row(i) = stage.force_at(i);
    return result;
  }
};

/// By 0.3 m; the face is a body's.
inline RandomPair vertex_above_a_face() {
  RandomPair pair;
  pair.inverse_mass = {2, 0, 0, 0};
  pair.interaction = make_interaction(PairKind::kVf, {0, 1, 2, 3}, {1, 0.25, 0.25, 0.5}, pair.inverse_mass);
  pair.x_t0 = {Vec3(0, 0, 0.3), Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(0, 1, 0)};
  return pair;
}

}  // namespace selvage::sim::testbed
