// The pairs that repel in a step: near at its start, and coming nearer.
#pragma once

#include <vector>

#include "kernel/proximities.h"
#include "sim/base/vertex_faces.h"
#include "sim/contact/near_pairs.h"
#include "sim/contact/repulsion_contact.h"

namespace selvage::sim {

class StartProximities {
 public:
  /// All must outlive this.
  StartProximities(const Mesh& mesh, const ContactTable& contacts, const VertexFaces& faces)
      : mesh_(mesh), contacts_(contacts), faces_(faces) {}

  /// A step from V_t0, of pairs with a flagged vertex (`surface`, #V). Where the bits of both are those of the last
  /// call, the near pairs of that are used again.
  void start(BoxHierarchy& hierarchy, const Positions& V_t0, const std::vector<std::uint8_t>& surface);

  /// The pairs that repel in a motion from V_t0 to V_t1 and were not among the answers since start(): nearer than
  /// kContactReach times their thickness at V_t0, approaching, given `fall` (near_pairs.h), or of `pressed`, which
  /// repel whatever the motion is, and local (local_proximities.h).
  [[nodiscard]] std::vector<PairProximity> find(const Positions& V_t1, const Vec3& fall = Vec3::Zero(),
                                                const Candidates& pressed = {});

  /// Until the next start() find() does not return the pairs of these.
  void leave_out(std::span<const RepulsionContact> contacts);

  /// Pairs since start() that repel but for that they need not be local.
  [[nodiscard]] std::int64_t count() const { return count_; }

 private:
  /// Asks the kernel about those of `pairs` (ascending) for which that was not done at V_t0 before.
  void decide(const std::vector<std::size_t>& pairs);

  const Mesh& mesh_;
  const ContactTable& contacts_;
  const VertexFaces& faces_;
  Positions V_t0_;
  std::vector<std::uint8_t> surface_;
  NearPairs near_;
  std::vector<std::int32_t> decision_;  ///< by near pair: its place in local_, or as below
  std::vector<PairProximity> local_;
  static constexpr std::int32_t kUndecided = -2, kNotLocal = -1;
  std::vector<std::size_t> known_;  ///< near pairs that an answer since start() was about; ascending
  std::int64_t count_ = 0;
};

}  // namespace selvage::sim
