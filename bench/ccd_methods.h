// The methods of `bench ccd`, each as one loop over a list of candidates, as a simulator would run it.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "bench/mesh_motion.h"
#include "bench/query_methods.h"
#include "kernel/ccd.h"

namespace selvage::bench {

/// A pair that a method does not call separated. `pair` counts within the list of its kind.
struct Alarm {
  std::size_t pair = 0;
  double toi = 0;
  double gap_bound = 0;  ///< of the kernel's collisions
  bool unresolved = false;
};

struct CcdAnswers {
  std::vector<Alarm> alarms;  ///< in the order of the candidates
  std::int64_t searched = 0;  ///< pairs that a fast look left to a slower query, where the method counts them
};

struct CcdMethod {
  const char* name;
  /// What it says of one kind of candidates. One thread.
  CcdAnswers (*ask)(PairKind, const MeshMotion&, const Candidates&, const CcdOptions&);
  bool gives_toi;
  bool gives_gap_bound;
};

/// kernel: CcdBatch on the whole list. kernel_scalar: vf_ccd and ee_ccd one by one. textbook: the baseline, one by one.
/// exact: the checker's bare decision.
[[nodiscard]] std::span<const CcdMethod> ccd_methods();

/// A candidate as the methods that answer one query take it.
[[nodiscard]] MethodQuery query_of(PairKind kind, const MeshMotion& motion, const Candidates& candidates,
                                   std::size_t pair);

}  // namespace selvage::bench
