#include "sim/response/blocked_bodies.h"

#include <algorithm>
#include <cmath>

#include "sim/contact/interaction.h"

namespace selvage::sim {
namespace {

/// The part of a body in the motion of one point of a pair relative to the other.
struct Share {
  double weight = 0;
  Vec3 at = Vec3::Zero(), way = Vec3::Zero();

  void add(double w, const StepMotion& motion, VertexId vertex) {
    weight += w;
    at += w * motion.V_t0().row(vertex).transpose();
    way += w * motion.displacement().row(vertex).transpose();
  }
};

/// With less of a point than this a body's place is lost in rounding, and so is what it has to do with the collision.
constexpr double kLeastWeight = 0x1p-10;

}  // namespace

void add_blockages(const Collision& collision, const std::array<VertexId, 4>& pair, const std::array<Mover, 4>& movers,
                   const ScriptedGroups& groups, const StepMotion& motion, std::vector<Blockage>& blockages) {
  const std::array<double, 4> weights = signed_weights(collision.kind, collision.ccd.weights);
  Share all;
  for (std::size_t i = 0; i < pair.size(); ++i) all.add(weights[i], motion, pair[i]);
  // The side of the normal is that from which the points come.
  const Vec3& normal = collision.ccd.normal;
  const Vec3 apart = all.way.dot(normal) < 0 ? normal : Vec3(-normal);
  const auto add_rigid = [&](GroupId group) {
    Share own;
    for (std::size_t i = 0; i < pair.size(); ++i) {
      if (movers[i].group == group) own.add(weights[i], motion, pair[i]);
    }
    if (!(std::abs(own.weight) >= kLeastWeight) || !(own.way.dot(apart) < 0)) return;
    const Vec3 direction = own.weight > 0 ? apart : Vec3(-apart);
    blockages.push_back({groups.body(group), Blockage::kWholeBody, own.at / own.weight, direction});
  };
  const auto add_vertices = [&](const Mover& mover, const Vec3& direction) {
    for (auto v = mover.vertices.begin(); v != mover.vertices.end(); ++v) {
      if (groups.group(*v) != mover.group || std::find(mover.vertices.begin(), v, *v) != v) continue;
      const Vec3 at = motion.V_t0().row(*v), way = motion.displacement().row(*v);
      if (way.dot(direction) < 0) blockages.push_back({groups.body(mover.group), *v, at, direction});
    }
  };
  std::vector<GroupId> rigid;  // that had their turn
  for (std::size_t i = 0; i < pair.size(); ++i) {
    const GroupId group = movers[i].group;
    if (group == ScriptedGroups::kCloth || !groups.is_body(group)) continue;
    if (groups.deforms(group)) {
      add_vertices(movers[i], is_in_first_feature(collision.kind, i) ? apart : Vec3(-apart));
    } else if (std::ranges::find(rigid, group) == rigid.end()) {
      rigid.push_back(group);
      add_rigid(group);
    }
  }
}

}  // namespace selvage::sim
