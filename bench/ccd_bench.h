// Speed against error on all candidates of a mesh motion: the kernel, the textbook method, the exact checker and a
// guest.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/guest_method.h"
#include "bench/mesh_motion.h"
#include "bench/pair_labels.h"
#include "bench/toi_error.h"

namespace selvage::bench {

struct CcdBenchOptions {
  double tolerance = 0;  ///< of the kernel, at t = 1; the truth is about touching, so 0 compares like with like
  int repeat = 3;        ///< timed passes over all candidates, >= 1
};

struct CcdMethodReport {
  std::string name;
  std::int64_t alarms = 0;
  std::int64_t false_negatives = 0, false_positives = 0;
  /// Of the false positives, those for which the exact checker did not confirm that the features come within gap_bound.
  /// Methods that give no bound count as giving zero, and a guest has the gap that it declares.
  std::int64_t false_positives_beyond_gap = 0;
  std::int64_t unresolved = 0;  ///< counted as alarms
  std::int64_t searched = 0;    ///< kernel: pairs that its lanes left to single queries
  bool gives_toi = false;
  std::int64_t toi_examined = 0;
  ToiError toi;
  double ns_mean = 0, ns_vf = 0, ns_ee = 0;  ///< a candidate
  double ratio = 0;                          ///< ns_mean to that of the textbook method
};

struct CcdBenchReport {
  std::string motion;
  std::int64_t vertices = 0, faces = 0;
  std::int64_t vf_candidates = 0, ee_candidates = 0;
  std::int64_t vf_contacts = 0, ee_contacts = 0;  ///< the exact checker's, over all candidates
  std::int64_t labels = 0;
  std::int64_t labels_contradicted =
      0;                      ///< verdicts that the exact checker does not share, or pairs that are no candidates
  double broad_phase_ns = 0;  ///< processor time of all threads, hierarchy included
  std::vector<CcdMethodReport> methods;  ///< those of ccd_methods(), and the guest
  std::optional<GuestFacts> guest;
};

/// What the broad phase finds for a motion, and the processor time of all threads that it took, hierarchy included.
struct TimedCandidates {
  Candidates pairs;
  double ns = 0;
};
[[nodiscard]] TimedCandidates time_candidates(const MeshMotion& motion, double tolerance);

/// Processor time of the thread for a whole pass over the queries of a kind, the best of the passes.
struct KindTimes {
  double vf = 0, ee = 0;
};

/// One thread. Times are processor time of whole passes over one kind of candidates, everything included that a method
/// does from positions to a list of alarms; the best of the passes, in which the methods take turns. Times of impact
/// are compared on a spread of the contacts. `guest` was measured before, on the vertex-face candidates and then those
/// of edges.
[[nodiscard]] CcdBenchReport run_ccd_bench(const MeshMotion& motion, TimedCandidates candidates,
                                           std::span<const LabelledPair> labels, const CcdBenchOptions& options,
                                           const std::optional<GuestMethod<KindTimes>>& guest = std::nullopt);

/// Schema selvage.bench.ccd/1.
[[nodiscard]] std::string to_json(const CcdBenchReport& report);

}  // namespace selvage::bench
