// Checks every step of a trial with exact arithmetic, and keeps the trial's account of steps.
#pragma once

#include <vector>

#include "bench/stability/trial.h"
#include "io/mesh_data.h"
#include "sim/collision_step.h"
#include "verify/check.h"

namespace selvage::bench {

class ExactWatch {
 public:
  /// `face_is_body`: as in verify::Surface; empty: no face is. The trial must outlive it.
  ExactWatch(Trial& trial, const io::Triangles& triangles, const std::vector<std::uint8_t>& face_is_body,
             std::int64_t vertex_count, const sim::CollisionOptions& options);

  /// Requires that the state is exactly free of intersections.
  void start(const Positions& x);
  /// Requires of a step from a state that was free: it is safe, its end and the motion to it are exactly free, and the
  /// report names every pair that ends it nearer than the tolerance.
  void step(const Positions& x_t0, const Positions& x_t1, const sim::CollisionStepReport& report);

 private:
  void require_free(const verify::CheckResult& result, const char* what);
  void watch_gap(const Positions& x, const sim::CollisionStepReport& report);

  Trial& trial_;
  verify::Topology topology_;
  double tolerance_m_;
};

}  // namespace selvage::bench
