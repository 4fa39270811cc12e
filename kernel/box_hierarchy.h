// The paper's bounding-box hierarchy (section 6): leaves are faces, adjacent nodes merged greedily in alternating
// sweeps, built once from connectivity, refit each step.
#pragma once

#include <memory>

#include "kernel/candidates.h"

namespace selvage {

class BoxHierarchy {
 public:
  /// Depends on connectivity alone. O(#F log #F). The mesh must outlive the hierarchy.
  explicit BoxHierarchy(const Mesh& mesh);
  ~BoxHierarchy();
  BoxHierarchy(BoxHierarchy&&) noexcept;
  BoxHierarchy& operator=(BoxHierarchy&&) noexcept;

  /// Boxes of the motion from V_t0 to V_t1 (pass one twice for an instant), grown as CandidateOptions says.
  void refit(const PositionsRef& V_t0, const PositionsRef& V_t1, const CandidateOptions& options);
  /// Equal to find_candidates_brute_force for the last refit (K6), for any thread count (K7).
  [[nodiscard]] Candidates candidates() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace selvage
