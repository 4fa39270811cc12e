// The queries of ccd.h for whole lists of candidates: in SIMD lanes, then one query after another for the rest.
//   What is left out is separated: PROVED, as vf_ccd and ee_ccd prove it. What is returned has their bits.
//   All pairs that they call separated are left out. So may be a pair on which they give up (kUnresolved), or whose
//   distance at t = 1 they cannot tell from tolerance: the cull sees it from another side.
//   Equal input bits give equal output bits on every SIMD width, and however a list is divided (K7).
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "kernel/candidates.h"
#include "kernel/ccd.h"

namespace selvage {

/// A pair that is not separated.
struct BatchAnswer {
  std::size_t candidate;  ///< its place in the list
  CcdResult ccd;          ///< as its single query answers
};
/// What a list comes to.
struct BatchReport {
  std::vector<BatchAnswer> answers;  ///< not separated, ascending
  std::int64_t searched = 0;         ///< pairs that the lanes left to single queries
  std::int64_t intervals = 0;        ///< of all queries; 1 for a pair that the lanes call separated
};

/// One motion of a mesh, prepared for any number of lists. Calls may come from several threads.
class CcdBatch {
 public:
  /// O(#V): copies the positions, and prepares them unless `query_count`, the number of queries to come, is so low that
  /// it does not pay. REQUIRES one position a vertex of the mesh, which must outlive the batch. Positions outside the
  /// domain are answered as by single queries.
  CcdBatch(const Mesh& mesh, const PositionsRef& V_t0, const PositionsRef& V_t1, const CcdOptions& options,
           std::size_t query_count);
  CcdBatch(const Mesh&&, const PositionsRef&, const PositionsRef&, const CcdOptions&, std::size_t) = delete;
  ~CcdBatch();

  /// REQUIRES candidates of the mesh. Fastest where neighbours in the list share their first feature.
  [[nodiscard]] BatchReport ask(std::span<const VfCandidate> candidates) const;
  /// Likewise.
  [[nodiscard]] BatchReport ask(std::span<const EeCandidate> candidates) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

}  // namespace selvage
