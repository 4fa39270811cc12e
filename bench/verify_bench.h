// The exact checker on layered sheets: one frame against CGAL's self_intersections, and the motion between two frames.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/rival_loader.h"
#include "bench/timed.h"

namespace selvage::bench {

struct VerifyBenchOptions {
  std::vector<int> faces{50'000, 500'000, 2'000'000};
  int layers = 0;                        ///< 0: 10 below 100,000 faces, 20 from there on
  std::vector<int> thread_counts{1, 2};  ///< each >= 1; the first is the reference of ratios
  int repeat = 3;                        ///< timed passes, >= 1; the best counts
  bool motion = false;                   ///< measure the motion too
};

/// One method on one sheet, in a process of its own.
struct VerifyMethodReport {
  std::string name;  ///< frame, motion: the checker's; cgal: self_intersections
  int thread_count = 1;
  BestTime build;  ///< what is done once for a mesh: Topology, Surface_mesh
  BestTime check;
  std::int64_t found = 0;               ///< pairs that intersect, or touch in motion
  std::int64_t missing = 0, extra = 0;  ///< pairs, against the first method of the same kind
  std::int64_t examined = 0;            ///< pairs whose boxes overlap, and faces; 0: not told
  std::int64_t exact = 0;               ///< of these, decided with exact arithmetic
  std::int64_t peak_bytes = 0;          ///< above those of a process that holds the input alone
};

struct VerifySheetReport {
  std::int64_t vertices = 0, faces = 0;
  int layers = 0;
  bool planted = false;  ///< 20 vertices pushed through the next layer: at rest, in motion at its end
  std::vector<VerifyMethodReport> methods;
};

/// Every size clean and planted. REQUIRES that this process has no threads yet. `rival` may be absent.
[[nodiscard]] std::vector<VerifySheetReport> run_verify_bench(const LoadedFrameRival& rival,
                                                              const VerifyBenchOptions& options);

/// Whether two methods found different pairs, a clean sheet had any, or a planted one none.
[[nodiscard]] bool is_wrong(const VerifySheetReport& report);

/// Schema selvage.bench.verify/1.
[[nodiscard]] std::string to_json(const std::vector<VerifySheetReport>& reports, const LoadedFrameRival& rival);

}  // namespace selvage::bench
