// Pairs that are near at the start of a step, and how each of them moves along its direction: which ones are worth a
// query of the kernel. In a heap of folded cloth most near pairs rest, and do not matter.
#pragma once

#include <optional>
#include <vector>

#include "kernel/candidates.h"
#include "sim/contact/contact_table.h"

namespace selvage::sim {

/// A pair by plain doubles, without a proof (quick_proximity.h).
struct NearPair {
  std::array<VertexId, 4> vertices;  ///< in the order of pair_vertices()
  std::array<double, 4> weights;     ///< signed, as in Interaction
  Vec3 direction;                    ///< unit; from the second feature to the first
  double distance, thickness_m;
};

class NearPairs {
 public:
  /// Of `candidates` those nearer than kContactReach thicknesses at V_t0, in order: vf before ee. Features of no size
  /// are near. In parallel; same bits for any number of threads.
  void find(const Mesh& mesh, const ContactTable& contacts, const Candidates& candidates, const Positions& V_t0);

  [[nodiscard]] std::size_t size() const { return pairs_.size(); }

  /// Those that come nearer than their thickness, along their direction, in a motion from V_t0 to V_t1; ascending. Or
  /// that nearly do, and would if one of the two stood still, which the motion does not know, while the other fell by
  /// `fall`. Where numbers overflow or features have no size a pair does.
  [[nodiscard]] std::vector<std::size_t> approaching(const Positions& V_t0, const Positions& V_t1,
                                                     const Vec3& fall = Vec3::Zero()) const;

  /// `pairs`, and all others that are as near as one of them to features on both sides: what a pair must be compared
  /// with to know whether its distance is a local minimum. Ascending, as `pairs`.
  [[nodiscard]] std::vector<std::size_t> with_nearer(const std::vector<std::size_t>& pairs) const;

  /// Whether pair i is this one.
  [[nodiscard]] bool is_pair(std::size_t i, PairKind kind, std::int32_t first, std::int32_t second) const;
  /// Nothing if it is none of them. O(log #pairs).
  [[nodiscard]] std::optional<std::size_t> place(PairKind kind, std::int32_t first, std::int32_t second) const;
  /// Of those of `pairs` that are among them; ascending.
  [[nodiscard]] std::vector<std::size_t> places(const Candidates& pairs) const;
  [[nodiscard]] Candidates candidates(const std::vector<std::size_t>& pairs) const;

 private:
  Candidates candidates_;
  std::vector<NearPair> pairs_;  ///< vf, then ee
  Eigen::Index vertex_count_ = 0;
};

}  // namespace selvage::sim
