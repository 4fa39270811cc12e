// The bounding-box hierarchy, a BVH (paper, section 6): leaves are faces; made once, refit each step.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "kernel/candidates.h"

namespace selvage {

/// How the tree over the faces is made. The candidates are the same; docs/measurements/broad-phase.md says what each
/// costs.
enum class HierarchyKind : std::uint8_t {
  kAutomatic,  ///< whichever of the two below has the smaller boxes: chosen at the first refit, and again as they grow
  kSpatial,    ///< by position: made at the first refit, and again as its boxes grow
  kTopology,   ///< the paper's: adjacent nodes are paired greedily in alternating sweeps, from connectivity alone, once
};

/// Finds the pairs whose boxes overlap, for one mesh and one motion after another.
class BoxHierarchy {
 public:
  /// O(#F log #F). The mesh must outlive the hierarchy.
  explicit BoxHierarchy(const Mesh& mesh, HierarchyKind kind = HierarchyKind::kAutomatic);
  explicit BoxHierarchy(Mesh&&, HierarchyKind = HierarchyKind::kAutomatic) = delete;
  ~BoxHierarchy();
  /// What was moved from may only be destroyed or assigned to.
  BoxHierarchy(BoxHierarchy&&) noexcept;
  /// As the constructor.
  BoxHierarchy& operator=(BoxHierarchy&&) noexcept;

  /// Whether the mesh may be the one it was made for: as many vertices, edges and faces. O(1).
  [[nodiscard]] bool fits(const Mesh& mesh) const;

  /// Boxes of the motion from V_t0 to V_t1 (pass one twice for an instant), grown as CandidateOptions says. O(#V + #F),
  /// in parallel; O(#F log #F) where the tree is made or chosen again. REQUIRES #V flags or none, a finite reach >= 0,
  /// and validate() == kNone, which alone it does not ask: without it candidates may be missing.
  void refit(const PositionsRef& V_t0, const PositionsRef& V_t1, const CandidateOptions& options);
  /// Equal to find_candidates_brute_force for the last refit (K6), for any thread count (K7). REQUIRES one.
  [[nodiscard]] Candidates candidates() const;
  /// Likewise, but nothing where there are more than `most`; takes memory for about so many. A motion that is long
  /// beside the features has O(#F^2) candidates.
  [[nodiscard]] std::optional<Candidates> candidates(std::size_t most) const;
  /// Calls `visit` with all of them, part by part: memory for some thousands a thread, and #E.
  void visit_candidates(const CandidateVisitor& visit) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace selvage
