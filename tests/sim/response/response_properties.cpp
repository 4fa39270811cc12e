#include "tests/sim/response/response_properties.h"

#include <cmath>

#include "sim/response/friction.h"
#include "sim/response/repulsion.h"
#include "tests/sim/mechanics.h"

namespace selvage::sim::testbed {
namespace {

void expect_distances_kept(const Nodes& nodes, const std::vector<Vec3>& moved, double error) {
  for (std::size_t i = 0; i < nodes.x.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vec3 before = nodes.x[i] - nodes.x[j];
      const Vec3 after = before + (moved[i] - moved[j]);  // exact far from the origin, where sums are not
      RC_ASSERT(std::abs(after.norm() - before.norm()) <= error);
    }
  }
}

}  // namespace

Nodes random_nodes(ZoneShape shape, double speed) {
  Nodes nodes;
  const Vec3 direction = vector_within(1);
  const int count = integer_in(4, 12);
  for (int i = 0; i < count; ++i) {
    Vec3 x = vector_within(1);
    if (shape == ZoneShape::kLine) x = number_between(-1, 1) * direction;
    if (shape == ZoneShape::kPoint) x = direction;
    nodes.x.push_back(x);
    nodes.displacement.push_back(vector_within(speed));
    nodes.inverse_mass.push_back(std::exp2(number_between(-6, 6)));
  }
  return nodes;
}

std::vector<Vec3> displacements(const RigidMotion& rigid, const std::vector<Vec3>& x) {
  std::vector<Vec3> result;
  for (const Vec3& p : x) result.push_back(rigid.displacement(p));
  return result;
}

void prop_impulse_does_what_is_asked() {
  const RandomPair pair = random_pair(false);
  const Vec3 asked = vector_within(2);
  const PairVectors after = sum(pair.displacement, distribute(pair.interaction, asked));
  const Vec3 gained = relative(pair.interaction, after) - relative(pair.interaction, pair.displacement);
  const double share = lever_share(pair.interaction);
  RC_ASSERT((gained - share * asked).norm() <= 1e-12 * (1 + asked.norm()));
  const Mechanics m0 = mechanics(pair.x_t0, pair.displacement, pair.inverse_mass);
  const Mechanics m1 = mechanics(pair.x_t0, after, pair.inverse_mass);
  RC_ASSERT((m1.linear - m0.linear).norm() <= 1e-12 * (m0.linear_scale + m1.linear_scale));
}

/// A pair that approaches within its thickness stops, one that is farther apart comes to it at most; with a spring it
/// leaves, by no more than the spring may.
void prop_repulsion_ends_the_approach() {
  const RandomPair pair = random_contact(number_between(1e-3, 0.4));
  RC_PRE(lever_share(pair.interaction) == 1);
  RepulsionContact contact;
  contact.interaction = pair.interaction;
  contact.x_t0 = pair.x_t0;
  contact.normal = Vec3::UnitZ();
  contact.distance = relative(pair.interaction, pair.x_t0).z();
  contact.mobility = effective_mobility(pair.interaction);
  CollisionOptions options;
  contact.properties.thickness_m = 0.25;
  options.repulsion_stiffness_n_m = integer_in(0, 2) == 0 ? 0 : 1000;
  Positions displacement(4, 3);
  for (Eigen::Index i = 0; i < 4; ++i) displacement.row(i) = pair.displacement[static_cast<std::size_t>(i)];
  FrictionLoad load;
  const RepulsionChange answer = repel_contact(contact, displacement, options, 1e-2, 0, load);
  const double before = relative(pair.interaction, pair.displacement).z();
  const double after = relative(pair.interaction, sum(pair.displacement, answer.change)).z();
  const double overlap = contact.properties.thickness_m - contact.distance;
  const double lowest = std::min(overlap, 0.0);
  RC_ASSERT(answer.repels || before >= lowest);
  RC_ASSERT(after >= lowest - 1e-12);
  const bool springs = options.repulsion_stiffness_n_m > 0 && overlap > 0;
  RC_ASSERT(after <= std::max(before, springs ? options.overlap_fraction * overlap : lowest) + 1e-12);
}

void prop_friction_keeps_momenta_and_the_cone() {
  const RandomPair pair = random_contact(number_between(0, 0.2));
  const double normal_change = number_between(0, 1);
  const double on_static = number_between(0, 2);
  const FrictionCoefficients friction{on_static, number_between(0, on_static), integer_in(0, 2) * number_between(0, 1)};
  FrictionLoad load{normal_change};
  const auto change = friction_change(pair.interaction, pair.x_t0, pair.displacement, Vec3::UnitZ(), friction, load);
  // A pair that slips by chance does not slip as it turns: there is friction.
  const Vec3 slip = relative(pair.interaction, pair.displacement).cwiseProduct(Vec3(1, 1, 0));
  if (on_static * normal_change > 0 && friction.on_kinetic > 0 && slip.norm() > 1e-6) RC_ASSERT(change.has_value());
  RC_PRE(change.has_value());
  const PairVectors after = sum(pair.displacement, *change);
  const Mechanics m0 = mechanics(pair.x_t0, pair.displacement, pair.inverse_mass);
  const Mechanics m1 = mechanics(pair.x_t0, after, pair.inverse_mass);
  RC_ASSERT((m1.linear - m0.linear).norm() <= 1e-12 * m0.linear_scale);
  RC_ASSERT((m1.angular - m0.angular).norm() <= 1e-12 * m0.angular_scale);
  RC_ASSERT(m1.energy <= m0.energy * (1 + 1e-13));
  // Together with the normal impulse of a full stop it adds no energy either.
  const double approach = relative(pair.interaction, pair.displacement).z();
  if (approach < 0) {
    const PairVectors both = sum(after, distribute(pair.interaction, -approach * Vec3::UnitZ()));
    RC_ASSERT(mechanics(pair.x_t0, both, pair.inverse_mass).energy <= m0.energy * (1 + 1e-13));
  }
  // The slip it takes away is at most mu_s times the normal change.
  const Vec3 slowed = relative(pair.interaction, *change);
  RC_ASSERT(slowed.norm() <= on_static * normal_change * (1 + 1e-12));
}

void prop_zone_keeps_distances_and_momentum(ZoneShape shape) {
  const Nodes nodes = random_nodes(shape, 3);
  const RigidMotion rigid = momentum_motion(nodes.x, nodes.displacement, nodes.inverse_mass);
  const std::vector<Vec3> moved = displacements(rigid, nodes.x);
  expect_distances_kept(nodes, moved, 1e-13);
  const Mechanics m0 = mechanics(nodes.x, nodes.displacement, nodes.inverse_mass);
  const Mechanics m1 = mechanics(nodes.x, moved, nodes.inverse_mass);
  RC_ASSERT((m1.linear - m0.linear).norm() <= 1e-12 * m0.linear_scale);
  RC_ASSERT(m1.energy <= m0.energy * (1 + 1e-12));
}

/// Up to 10^9 lengths from the origin, with masses and speeds over six orders of magnitude.
void prop_far_zone_keeps_distances_and_momentum(ZoneShape shape) {
  Nodes nodes = random_nodes(shape, 3);
  const double distance = *rc::gen::element(0.0, 1e3, 1e6, 1e9);
  const Vec3 origin = distance * vector_within(1);
  for (std::size_t i = 0; i < nodes.x.size(); ++i) {
    nodes.x[i] += origin;
    nodes.displacement[i] *= std::pow(10, number_between(-6, 0));
    nodes.inverse_mass[i] = std::pow(10, number_between(0, 6));
  }
  const RigidMotion rigid = momentum_motion(nodes.x, nodes.displacement, nodes.inverse_mass);
  const std::vector<Vec3> moved = displacements(rigid, nodes.x);
  expect_distances_kept(nodes, moved, 1e-13);
  const Mechanics m0 = mechanics(nodes.x, nodes.displacement, nodes.inverse_mass);
  const Mechanics m1 = mechanics(nodes.x, moved, nodes.inverse_mass);
  RC_ASSERT((m1.linear - m0.linear).norm() <= 1e-13 * m0.linear_scale);
}

void prop_zone_keeps_angular_momentum(ZoneShape shape) {
  const double speed = 1e-9;
  const Nodes nodes = random_nodes(shape, speed);
  const RigidMotion rigid = momentum_motion(nodes.x, nodes.displacement, nodes.inverse_mass);
  RC_PRE(rigid.turn.norm() < 1e-6);
  const std::vector<Vec3> moved = displacements(rigid, nodes.x);
  const Mechanics m0 = mechanics(nodes.x, nodes.displacement, nodes.inverse_mass);
  const Mechanics m1 = mechanics(nodes.x, moved, nodes.inverse_mass);
  const double angle = rigid.turn.norm();
  RC_ASSERT((m1.angular - m0.angular).norm() <= (1e-6 + angle) * 1e-3 * m0.angular_scale + 1e-12 * m0.angular_scale);
}

}  // namespace selvage::sim::testbed
