#include "sim/contact/start_proximities.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>

#include "kernel/assert.h"
#include "sim/base/parallel.h"
#include "sim/base/points.h"
#include "sim/base/sorted_once.h"
#include "sim/contact/contact_reach.h"
#include "sim/contact/local_proximities.h"

namespace selvage::sim {

void StartProximities::start(BoxHierarchy& hierarchy, const Positions& V_t0, const std::vector<std::uint8_t>& surface) {
  known_.clear();
  count_ = 0;
  if (V_t0.rows() > 0 && same_bits(V_t0, V_t0_) && surface == surface_) return;
  V_t0_.resize(0, 3);  // if an exception ends this, what is known is of no positions
  const double reach = kContactReach * contacts_.thickness_upper();
  near_.find(mesh_, contacts_, find_near_candidates(mesh_, hierarchy, V_t0, reach, surface), V_t0);
  decision_.assign(near_.size(), kUndecided);
  local_.clear();
  surface_ = surface;
  V_t0_ = V_t0;
}

void StartProximities::leave_out(std::span<const RepulsionContact> contacts) {
  std::vector<std::array<std::optional<std::size_t>, 2>> places(contacts.size());
  parallel_each(std::ssize(contacts), [&](Eigen::Index i) {
    const RepulsionContact& held = contacts[static_cast<std::size_t>(i)];
    auto& [met, now] = places[static_cast<std::size_t>(i)];
    met = near_.place(held.kind, held.first, held.second_t0);
    if (held.second != held.second_t0) now = near_.place(held.kind, held.first, held.second);
  });
  for (const auto& of_contact : places) {
    for (const auto& place : of_contact) {
      if (place) known_.push_back(*place);
    }
  }
  keep_sorted_once(known_);
}

std::vector<PairProximity> StartProximities::find(const Positions& V_t1, const Vec3& fall, const Candidates& pressed) {
  std::vector<std::size_t> repelling, found, known;
  std::ranges::set_union(near_.approaching(V_t0_, V_t1, fall), near_.places(pressed), std::back_inserter(repelling));
  std::ranges::set_difference(repelling, known_, std::back_inserter(found));
  count_ += std::ssize(found);
  decide(found);
  std::ranges::set_union(known_, found, std::back_inserter(known));
  known_ = std::move(known);
  std::vector<PairProximity> result;
  result.reserve(found.size());
  for (const std::size_t pair : found) {
    if (decision_[pair] != kNotLocal) result.push_back(local_[static_cast<std::size_t>(decision_[pair])]);
  }
  return result;
}

void StartProximities::decide(const std::vector<std::size_t>& pairs) {
  std::vector<std::size_t> open;
  std::ranges::copy_if(pairs, std::back_inserter(open), [&](std::size_t i) { return decision_[i] == kUndecided; });
  if (open.empty()) return;
  const std::vector<std::size_t> asked = near_.with_nearer(open);
  std::vector<PairProximity> near =
      ask_proximities(mesh_, V_t0_, near_.candidates(asked), kContactReach * contacts_.thickness_upper());
  if (!contacts_.is_uniform()) {
    std::erase_if(near, [&](const PairProximity& pair) {
      return !(pair.proximity.distance_lower <
               kContactReach * contacts_.of(pair.kind, pair.first, pair.second).thickness_m);
    });
  }
  const std::vector<PairProximity> found = local_proximities(mesh_, faces_, V_t0_, near, contacts_.thickness_upper());
  local_.reserve(local_.size() + found.size());  // nothing throws from here on
  for (const std::size_t pair : open) decision_[pair] = kNotLocal;
  // All three are in the same order.
  auto place = asked.begin();
  auto next_open = open.begin();
  for (const PairProximity& pair : found) {
    place = std::find_if(place, asked.end(),
                         [&](std::size_t i) { return near_.is_pair(i, pair.kind, pair.first, pair.second); });
    SELVAGE_ASSERT(place != asked.end());
    next_open = std::find_if(next_open, open.end(), [&](std::size_t i) { return i >= *place; });
    if (next_open == open.end()) break;
    if (*next_open != *place) continue;  // asked only to compare others with it
    decision_[*place] = static_cast<std::int32_t>(local_.size());
    local_.push_back(pair);
  }
}

}  // namespace selvage::sim
