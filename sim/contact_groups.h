// Which contacts may act at the same time. Contacts act one after the other, each on what those before it have done;
// those that share no vertex may do so in any order, and so at once.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <oneapi/tbb/parallel_for.h>

#include "kernel/fp_env.h"
#include "kernel/types.h"

namespace selvage::sim {

class ContactGroups {
 public:
  struct Member {
    std::array<VertexId, 4> vertices;  ///< -1 for those that do not move: any contacts may share them
    Vec3 at;                           ///< contacts near each other share vertices more often than others
  };

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
  ContactGroups(std::span<const Member> members, Eigen::Index vertex_count);

  /// All members, in the order in which they act, but for those that leave their group: laid out so in memory they are
  /// read one after the other.
  [[nodiscard]] const std::vector<std::size_t>& order() const { return order_; }

  /// Calls act(place in order(), reach) for each: rounds of groups that share no vertex, the groups of a round in
  /// parallel, then those left over, alone, in whose reach is all; or all that backwards. Where act() needs what is not
  /// in its reach it must change nothing and return false: it is called again after all others, and from then on
  /// always alone. Same bits for any number of threads.
  template <typename Act>
  void each(bool backwards, const Act& act) {
    if (backwards) act_alone(backwards, act);
    for (std::size_t k = 0; k < rounds_.size(); ++k) {
      act_round(rounds_[backwards ? rounds_.size() - 1 - k : k], backwards, act);
    }
    if (!backwards) act_alone(backwards, act);
    for (Round& round : rounds_) act_leaving(round, act);
  }

 private:
  struct Group {
    std::size_t begin = 0, end = 0;    ///< in order()
    std::vector<std::size_t> leaving;  ///< in this pass
  };
  struct Round {
    std::vector<Group> groups;
    std::vector<std::int32_t> owner;  ///< #V: which of the groups, or -1
  };

  template <typename Act>
  void act_round(Round& round, bool backwards, const Act& act) {
    tbb::parallel_for(std::size_t{0}, round.groups.size(), [&](std::size_t id) {
      const FpEnvGuard guard;
      Group& group = round.groups[id];
      const Reach reach(round.owner, id);
      for (std::size_t k = 0; k < group.end - group.begin; ++k) {
        const std::size_t place = backwards ? group.end - 1 - k : group.begin + k;
        if (has_left_[place] == 0 && !act(place, reach)) group.leaving.push_back(place);
      }
    });
  }

  template <typename Act>
  void act_alone(bool backwards, const Act& act) const {
    for (std::size_t k = 0; k < alone_.size(); ++k) act(alone_[backwards ? alone_.size() - 1 - k : k], Reach::all());
  }

  template <typename Act>
  void act_leaving(Round& round, const Act& act) {
    for (Group& group : round.groups) {
      for (const std::size_t place : group.leaving) {
        act(place, Reach::all());
        has_left_[place] = 1;
      }
      alone_.insert(alone_.end(), group.leaving.begin(), group.leaving.end());
      group.leaving.clear();
    }
  }

  std::vector<Round> rounds_;
  std::vector<std::size_t> order_, alone_;  ///< alone: places in order()
  std::vector<std::uint8_t> has_left_;      ///< of a place: its group
};

}  // namespace selvage::sim
