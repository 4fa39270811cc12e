// Which contacts may act at the same time. Contacts act one after the other, each on what those before it have done;
// those that share no vertex may do so in any order, and so at once (a colouring of the graph of contacts).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "kernel/fp_env.h"
#include "kernel/own_tasks.h"
#include "kernel/types.h"
#include "sim/base/lane_vectors.h"

namespace selvage::sim {

class ContactGroups {
 public:
  struct Member {
    std::array<VertexId, 4> vertices;  ///< -1 for those that do not move: any contacts may share them
    Vec3 at;                           ///< contacts near each other share vertices more often than others
  };

  /// Of those in a group that share a vertex: as they are given, or nearly so, which fills packs better.
  enum class Order { kAsGiven, kNearly };

  /// Which vertices a contact may read and write now. All may read those that do not move.
  class Reach {
   public:
    /// REQUIRES a vertex that moves.
    [[nodiscard]] bool has(VertexId vertex) const {
      return owner_.empty() || owner_[static_cast<std::size_t>(vertex)] == group_;
    }

   private:
    friend class ContactGroups;
    Reach(std::span<const std::int32_t> owner, std::size_t group)
        : owner_(owner), group_(static_cast<std::int32_t>(group)) {}
    [[nodiscard]] static Reach all() { return {{}, 0}; }

    std::span<const std::int32_t> owner_;  ///< as in Round; none where all vertices are in reach
    std::int32_t group_;
  };

  ContactGroups() = default;
  /// REQUIRES vertices below `vertex_count`, and |at| <= 2 kMaxCoordinate. O(n log n), n = #members, and
  /// O(vertex_count) time and memory for each round: each takes a fifth of what is left or more (contact_groups.cpp),
  /// so there are 1 + 4.5 ln(n / 512) at most, and eight where 20,000 contacts press in a heap.
  ContactGroups(std::span<const Member> members, Eigen::Index vertex_count, Order order);

  /// All members in the order in which they act, but for those that have left: kLanes a pack, from pack * kLanes on.
  /// Those of a pack share no vertex, and act at once. Places without a member are kNobody.
  [[nodiscard]] const std::vector<std::size_t>& order() const { return order_; }
  static constexpr std::size_t kNobody = static_cast<std::size_t>(-1);

  /// Those of a pack that act with it.
  [[nodiscard]] LaneMask together(std::size_t pack) const { return together_[pack]; }

  /// Of those asked to act, who have not.
  struct Refused {
    LaneMask out_of_reach = 0;  ///< need what is not in their reach
    LaneMask at_once = 0;       ///< share a vertex with one of their pack
  };

  /// Calls act(pack, lanes, reach), which says who refused, for all: rounds of groups that share no vertex, the groups
  /// of a round in parallel, then those left over, alone, in whose reach is all; or all that backwards. Who refuses
  /// acts after the packs of its group, or, out of reach, after all others; one by one, and so from then on. Same bits
  /// for any number of threads.
  template <typename Act>
  void each(bool backwards, const Act& act) {
    if (backwards) act_group(alone_, Reach::all(), backwards, act);
    for (std::size_t k = 0; k < rounds_.size(); ++k) {
      act_round(rounds_[backwards ? rounds_.size() - 1 - k : k], backwards, act);
    }
    if (!backwards) act_group(alone_, Reach::all(), backwards, act);
    for (Round& round : rounds_) act_leaving(round, act);
  }

 private:
  struct Group {
    std::size_t begin = 0, end = 0;    ///< packs
    std::vector<std::size_t> singles;  ///< places of those that act one by one
    std::vector<std::size_t> leaving;  ///< in this pass
  };
  struct Round {
    std::vector<Group> groups;
    std::vector<std::int32_t> owner;  ///< #V: which of the groups, or -1
  };

  /// `packs_of` has zero for each vertex.
  [[nodiscard]] Group add_group(std::span<const Member> members, std::span<const std::size_t> group, Order order,
                                std::vector<std::uint64_t>& packs_of);

  template <typename Act>
  void act_round(Round& round, bool backwards, const Act& act) {
    own_parallel_for(std::size_t{0}, round.groups.size(), [&](std::size_t id) {
      const FpEnvGuard guard;
      act_group(round.groups[id], Reach(round.owner, id), backwards, act);
    });
  }

  template <typename Act>
  void act_group(Group& group, const Reach& reach, bool backwards, const Act& act) {
    for (std::size_t k = 0; k < group.end - group.begin; ++k) {
      const std::size_t pack = backwards ? group.end - 1 - k : group.begin + k;
      if (together_[pack] == 0) continue;
      const Refused refused = act(pack, together_[pack], reach);
      together_[pack] &= static_cast<LaneMask>(~(refused.out_of_reach | refused.at_once));
      for (std::size_t lane = 0; lane < kLanes; ++lane) {
        if (has_lane(refused.out_of_reach, lane)) group.leaving.push_back(pack * kLanes + lane);
        if (has_lane(refused.at_once, lane)) group.singles.push_back(pack * kLanes + lane);
      }
    }
    std::vector<std::size_t> stay;
    for (const std::size_t place : group.singles) {
      const bool leaves = act_single(place, reach, act).out_of_reach != 0;
      (leaves ? group.leaving : stay).push_back(place);
    }
    group.singles = std::move(stay);
  }

  template <typename Act>
  static Refused act_single(std::size_t place, const Reach& reach, const Act& act) {
    return act(place / kLanes, only_lane(place % kLanes), reach);
  }

  template <typename Act>
  void act_leaving(Round& round, const Act& act) {
    for (Group& group : round.groups) {
      for (const std::size_t place : group.leaving) act_single(place, Reach::all(), act);
      alone_.singles.insert(alone_.singles.end(), group.leaving.begin(), group.leaving.end());
      group.leaving.clear();
    }
  }

  std::vector<Round> rounds_;
  Group alone_;
  std::vector<std::size_t> order_;
  std::vector<LaneMask> together_;  ///< by pack
};

}  // namespace selvage::sim
