// Contacts held over one face or a few.
#pragma once

#include <functional>
#include <vector>

#include "sim/dynamics/swept_contacts.h"
#include "tests/sim/mechanics.h"

namespace selvage::sim::testbed {

inline constexpr double kHeldThickness = 0.25, kHeldStep = 0.125;

/// What contacts are on: `faces` over all vertices, of which those with mass come first.
struct Ground {
  Mesh mesh;
  SurfaceParts parts;
  VertexFaces faces;
  ContactTable properties;
  std::vector<double> inverse_mass;

  Ground(const Faces& F, std::vector<double> inverse_masses)
      : mesh(make_mesh(static_cast<std::int32_t>(inverse_masses.size()), F)),
        parts(mesh),
        faces(mesh),
        properties(mesh, options(), {}),
        inverse_mass(std::move(inverse_masses)) {}
  static CollisionOptions options() {
    CollisionOptions options;
    options.thickness_m = kHeldThickness;
    return options;
  }
  [[nodiscard]] HeldSurface surface(Eigen::Index cloth_count) const {
    return {mesh, parts, faces, properties, inverse_mass, cloth_count, -Vec3::UnitZ()};
  }
};

/// Contacts that are swept over, and know it after every step.
class Swept : public HeldContacts {
 public:
  using HeldContacts::HeldContacts;
  Swept(const Swept&) = delete;  // swept_ would go on with the other
  Swept& operator=(const Swept&) = delete;
  void hold(const MidstepMotion& step, const std::function<void()>& limit) {
    swept_.hold(step, limit);
    swept_.finish();
  }
  /// As they are given on.
  [[nodiscard]] std::vector<RepulsionContact> taken() const { return HeldContacts(*this).take_contacts(); }

 private:
  SweptContacts swept_{*this};
};

inline void act(Swept& held, const MidstepMotion& step) {
  held.hold(step, [] {});
}

/// The face of the contact alone.
inline Ground one_face() { return {Faces{{1, 2, 3}}, std::vector<double>(4, 0.0)}; }

/// Four vertices of one contact, along z at the start.
struct OneContact {
  RepulsionContact contact;
  Positions V_t0, V_t1;
  Eigen::Index cloth_count;
  LaneVectors x, v;
  ContactLoads loads;
  Candidates repelled;

  OneContact(const RandomPair& pair, Eigen::Index cloth_vertices) : V_t0(4, 3), cloth_count(cloth_vertices) {
    for (Eigen::Index i = 0; i < 4; ++i) V_t0.row(i) = pair.x_t0[static_cast<std::size_t>(i)];
    V_t1 = V_t0;
    contact = contact_of(pair, kHeldThickness);
    x.copy(V_t0.topRows(cloth_count));
    v.resize(cloth_count);
    for (Eigen::Index i = 0; i < cloth_count; ++i) v.row(i) = pair.displacement[static_cast<std::size_t>(i)];
  }

  /// One step of a collision step of one, which begins with a load. Leaves the load that it ends with, and its pair if
  /// it repelled.
  RepulsionCount step(double load_m_s2 = 0, int sweeps = 1, const Vec3& friction_m_s2 = Vec3::Zero()) {
    for (Eigen::Index i = 0; i < cloth_count; ++i) x.row(i) += kHeldStep * v.row(i);
    const std::vector<RepulsionContact> contacts{contact};
    const Ground ground = one_face();
    const ContactLoad load{
        contact.first, contact.second, load_m_s2, {friction_m_s2.x(), friction_m_s2.y(), friction_m_s2.z()}};
    ContactLoads begun;
    (contact.kind == PairKind::kVf ? begun.vf : begun.ee) = {load};
    Swept held(contacts, begun, ground.surface(cloth_count), V_t0, V_t1, kHeldStep, sweeps);
    act(held, {kHeldStep, 1, x, v});
    loads = held.loads();
    repelled = held.repelled_pairs();
    return held.count();
  }

  /// After a step: one load at most.
  [[nodiscard]] const std::vector<ContactLoad>& borne() const {
    return contact.kind == PairKind::kVf ? loads.vf : loads.ee;
  }

  [[nodiscard]] PairVectors velocities() const {
    PairVectors result = zero_vectors();
    for (Eigen::Index i = 0; i < cloth_count; ++i) result[static_cast<std::size_t>(i)] = v.row(i);
    return result;
  }
  /// Along the direction, at the end.
  [[nodiscard]] double distance() const {
    PairVectors at;
    for (Eigen::Index i = 0; i < 4; ++i) {
      at[static_cast<std::size_t>(i)] = i < cloth_count ? Vec3(x.row(i)) : Vec3(V_t1.row(i));
    }
    return relative(contact.interaction, at).dot(contact.normal);
  }
};

inline Vec3 friction_of(const ContactLoad& load) { return Vec3(load.friction_m_s2.data()); }

/// One step of the dynamics in which the first vertex moves at v, m/s.
inline void move_and_hold(OneContact& one, Swept& held, const Eigen::RowVector3d& v, double share) {
  one.v.row(0) = v;
  one.x.row(0) += kHeldStep * v;
  act(held, {kHeldStep, share, one.x, one.v});
}

/// A vertex a thickness above the middle of a face of a body, which moves by `moved` within the step.
inline OneContact vertex_over_body(const Vec3& velocity, const Vec3& moved = Vec3::Zero()) {
  RandomPair pair;
  pair.x_t0 = {Vec3(0, 0, kHeldThickness), Vec3(-2, -2, 0), Vec3(2, -2, 0), Vec3(0, 4, 0)};
  pair.displacement = {velocity, Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  pair.interaction =
      make_interaction(PairKind::kVf, {0, 1, 2, 3}, {1, 1.0 / 3, 1.0 / 3, 1.0 / 3}, std::array<double, 4>{1, 0, 0, 0});
  OneContact one(pair, 1);
  one.contact.properties.friction_static = 0.5;
  one.contact.properties.friction_kinetic = 0.4;
  for (Eigen::Index i = 1; i < 4; ++i) one.V_t1.row(i) += moved.transpose();
  return one;
}

/// A vertex, and a flat body of two faces that meet at y = -2: the first as in vertex_over_body().
struct TwoFaces {
  Positions V = Positions(5, 3);
  OneContact one = vertex_over_body(Vec3::Zero());
  Ground ground{Faces{{1, 2, 3}, {2, 1, 4}}, {1, 0, 0, 0, 0}};

  TwoFaces() {
    V.topRows(4) = one.V_t0;
    V.row(4) << 0, -6, 0;
  }
};

}  // namespace selvage::sim::testbed
