// Speed against error of every method at every setting, on sets of queries: typical cloth, and the hard classes.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bench/mesh_motion.h"
#include "bench/query_methods.h"
#include "bench/toi_error.h"

namespace selvage::bench {

struct QuerySet {
  std::string name, what;
  std::vector<MethodQuery> queries;
  /// All candidates of a mesh's motion, which are asked in batches as well; `queries` are some of them.
  const MeshMotion* motion = nullptr;
  Candidates candidates;
  std::vector<std::size_t> place;  ///< of each query in `candidates`, vf before ee, ascending
};

/// The queries are runs of 256 neighbours among the candidates, spread evenly over the lists, at most about `most` of
/// both kinds together. `motion` must outlive the set.
[[nodiscard]] QuerySet candidate_set(const std::string& name, const MeshMotion& motion, std::size_t most);

struct MethodBenchOptions {
  int repeat = 5;  ///< timed passes over a set, >= 1; one for a method that takes more than a second for it
};

struct SettingReport {
  std::string method, setting;
  std::int64_t misses = 0;        ///< called separated, though they touch exactly
  std::int64_t false_alarms = 0;  ///< not called separated, though they do not touch
  std::int64_t gave_up = 0;       ///< of the alarms
  std::int64_t toi_examined = 0;  ///< touching pairs with an alarm, for methods that give a time
  ToiError toi;
  double toi_off_p99 = 0;  ///< |answer - first touch|, early or late: 99th percentile
  double ns = 0;           ///< a query: processor time of the best pass; in batches: over all candidates
  double ratio = 0;        ///< to the baseline's, same set, same run
};

struct SetReport {
  std::string name, what;
  std::int64_t vf = 0, ee = 0, touching = 0;
  std::vector<SettingReport> settings;
};

/// One thread. The exact checker says the truth. All methods take turns, pass by pass, each in an order of the queries
/// that depends on the pass alone (that of the list for candidates of a mesh).
[[nodiscard]] SetReport run_method_bench(const QuerySet& set, const MethodBenchOptions& options);

/// A method that promises never to miss, nor to be late, did: the kernel, inclusion.
[[nodiscard]] bool breaks_promise(const SetReport& report);

/// Schema selvage.bench.methods/1.
[[nodiscard]] std::string to_json(std::span<const SetReport> reports);

}  // namespace selvage::bench
