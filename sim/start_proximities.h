// The proximities at the start of a step. They depend on nothing else, so that they outlive a try with another dt.
#pragma once

#include <vector>

#include "kernel/collisions.h"
#include "sim/contact_table.h"

namespace selvage::sim {

class StartProximities {
 public:
  /// Those at V_t0, of pairs with a flagged vertex (`surface`, #V). Where the bits of both are those of the last call,
  /// nothing is done: all calls have the same mesh and the same contacts.
  void find(const Mesh& mesh, BoxHierarchy& hierarchy, const ContactTable& contacts, const Positions& V_t0,
            const std::vector<std::uint8_t>& surface);

  /// Pairs nearer than kContactReach times their thickness.
  [[nodiscard]] std::int64_t count() const { return count_; }
  /// Those of them that are contacts (local_proximities.h).
  [[nodiscard]] const std::vector<PairProximity>& local() const { return local_; }

 private:
  Positions V_t0_;
  std::vector<std::uint8_t> surface_;
  std::int64_t count_ = 0;
  std::vector<PairProximity> local_;
};

}  // namespace selvage::sim
