// The broad phase against the same boxes in other libraries: candidates, and the time to build, refit and query.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/mesh_motion.h"
#include "bench/rival_loader.h"
#include "bench/timed.h"

namespace selvage::bench {

struct BroadBenchOptions {
  int repeat = 3;                        ///< timed passes, >= 1; the best counts
  std::vector<int> thread_counts{1, 2};  ///< each >= 1
  int sampled = 200;                     ///< vertices and edges whose candidates are compared with brute force
  bool incremental = true;               ///< measure detection among a share of moved vertices
};

struct BroadMethodReport {
  std::string name;  ///< automatic, spatial, topology: the kernel's hierarchies; cgal, embree
  int thread_count = 1;
  std::int64_t vf = 0, ee = 0;
  std::int64_t missing = 0, extra = 0;  ///< pairs, against the kernel's default hierarchy
  BestTime build, query;
  BestTime refit;  ///< 0 where the method has none but building again
};

/// Detection with the default hierarchy, one thread, when only some vertices have moved.
struct BroadIncrementalReport {
  std::string spread;  ///< patch: neighbours on the surface; scattered: evenly over the vertex numbers
  std::int64_t active_vertices = 0, candidates = 0;
  BestTime refit, query;
};

struct BroadMotionReport {
  std::string motion;
  std::int64_t vertices = 0, edges = 0, faces = 0, vf = 0, ee = 0;
  std::int64_t sampled = 0;      ///< features whose candidates were found by brute force too
  std::int64_t differences = 0;  ///< candidates in one of the two only
  /// Refit and query of the default hierarchy on one thread: CPU nanoseconds over (#F log2 #F + candidates).
  double ns_per_work = 0;
  std::vector<BroadMethodReport> methods;
  std::vector<BroadIncrementalReport> incremental;
};

/// Reach is 0: boxes of the motion, as they are. REQUIRES at least one face and one thread count.
[[nodiscard]] BroadMotionReport run_broad_bench(const MeshMotion& motion, std::span<const LoadedRival> rivals,
                                                const BroadBenchOptions& options);

/// Whether the kernel's hierarchies differ from each other or from brute force.
[[nodiscard]] bool is_wrong(const BroadMotionReport& report);

/// Schema selvage.bench.broad/1. Rivals that are not here are listed with the reason.
[[nodiscard]] std::string to_json(std::span<const BroadMotionReport> reports, std::span<const LoadedRival> rivals);

}  // namespace selvage::bench
