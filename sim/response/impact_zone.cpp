#include "sim/response/impact_zone.h"

#include <algorithm>
#include <array>
#include <optional>

#include "sim/base/sorted_once.h"

namespace selvage::sim {
namespace {

constexpr std::int32_t kNoScript = -2;
constexpr std::int32_t kAtRest = -1;  // all scripts at rest are the same motion; a moving one is its group

/// What a union follows, or nothing where two differ.
std::optional<std::int32_t> common_script(std::int32_t a, std::int32_t b) {
  if (a == kNoScript) return b;
  if (b == kNoScript || a == b) return a;
  return std::nullopt;
}

}  // namespace

ImpactZones::ImpactZones(VertexId vertex_count, const ScriptedGroups& groups) : groups_(groups) {
  for (VertexId v = 0; v < vertex_count; ++v) {
    zone_.push_back(v);
    members_.push_back({v});
    script_.push_back(script_of(v));
  }
}

std::int32_t ImpactZones::script_of(VertexId vertex) const {
  const GroupId group = groups_.group(vertex);
  if (group == ScriptedGroups::kCloth) return kNoScript;
  return groups_.moves(group) ? group : kAtRest;
}

bool ImpactZones::merge(const std::array<VertexId, 4>& pair) {
  std::int32_t target = zone(pair[0]);  // the largest: a vertex changes its zone log2 #V times at most
  std::optional<std::int32_t> script = kNoScript;
  for (const VertexId v : pair) {
    if (members(zone(v)).size() > members(target).size()) target = zone(v);
    if (script) script = common_script(*script, script_[static_cast<std::size_t>(zone(v))]);
  }
  const bool is_one = std::ranges::all_of(pair, [&](VertexId v) { return zone(v) == target; });
  if (is_one || !script) return false;
  std::vector<VertexId>& into = members_[static_cast<std::size_t>(target)];
  for (const VertexId v : pair) {
    if (zone(v) == target) continue;
    std::vector<VertexId> from;
    from.swap(members_[static_cast<std::size_t>(zone(v))]);
    into.insert(into.end(), from.begin(), from.end());
    for (const VertexId member : from) zone_[static_cast<std::size_t>(member)] = target;
  }
  script_[static_cast<std::size_t>(target)] = *script;
  largest_ = std::max(largest_, static_cast<std::int32_t>(into.size()));
  grown_.push_back(target);
  return true;
}

void ImpactZones::move_grown(const Positions& displacement, std::span<const double> inverse_mass, StepMotion& motion) {
  keep_sorted_once(grown_);
  for (const std::int32_t id : grown_) {
    if (members(id).empty()) continue;
    std::ranges::sort(members_[static_cast<std::size_t>(id)]);  // the order of sums
    const std::int32_t script = script_[static_cast<std::size_t>(id)];
    RigidMotion rigid;
    if (script >= 0) rigid = groups_.rigid_motion(script, motion, members(id));
    if (script == kNoScript) {
      std::vector<Vec3> x, d;
      std::vector<double> m;
      for (const VertexId v : members(id)) {
        x.emplace_back(motion.V_t0().row(v));
        d.emplace_back(displacement.row(v));
        m.push_back(inverse_mass[static_cast<std::size_t>(v)]);
      }
      rigid = momentum_motion(x, d, m);
    }
    for (const VertexId v : members(id)) {
      if (!groups_.is_scripted(v)) motion.move(v, rigid.displacement(motion.V_t0().row(v)));
    }
  }
  grown_.clear();
}

}  // namespace selvage::sim
