// Scenes that start intersecting, repaired and judged by the exact checker.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "sim/repair/untangle.h"
#include "tests/sim/step_scene.h"

namespace selvage::sim::testbed {

inline FindIntersections exact_judge(const StepScene& scene) {
  return [surface = verify::Surface{scene.triangles, scene.face_is_body}](const Positions& V) {
    verify::CheckOptions options;
    options.max_violations = 1'000'000;
    std::vector<FacePair> pairs;
    for (const verify::Violation& found : check_frame(surface, points_of(V), options).violations) {
      pairs.push_back(verify::faces_of(found));
    }
    std::ranges::sort(pairs);
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    return pairs;
  };
}

inline UntangleResult untangle_scene(const StepScene& scene, double gap_m = 1e-3) {
  UntangleOptions options;
  options.gap_m = gap_m;
  options.precision = scene.options.precision;
  options.surfaces = scene.surfaces;
  return untangle(scene.mesh(), scene.V_t0, scene.bodies(), options, exact_judge(scene));
}

/// What holds for every repair, whether it succeeded or not; "" for nothing wrong.
inline std::string defect_of(const StepScene& scene, const UntangleResult& result) {
  if (result.x.rows() != scene.V_t0.rows() || !result.x.allFinite()) return "not the positions of the scene";
  const bool is_clean = exact_defect(scene, result.x).empty();
  if (is_clean != result.report.remaining.empty()) return "it does not say whether it is clean";
  if (!is_clean && result.x != scene.V_t0) return "half repaired";
  for (Eigen::Index v = 0; v < result.x.rows(); ++v) {
    const bool moves = result.x.row(v) != scene.V_t0.row(v);
    if (moves && scene.inverse_mass[static_cast<std::size_t>(v)] == 0) return "a script was left";
  }
  return "";
}

/// Repairs, and requires that it worked with no vertex moved farther.
inline void expect_repaired(const StepScene& scene, double largest_move_m) {
  ASSERT_NE(exact_defect(scene, scene.V_t0), "") << "the case is no tangle";
  const UntangleResult result = untangle_scene(scene);
  EXPECT_EQ(defect_of(scene, result), "");
  EXPECT_TRUE(result.report.remaining.empty()) << result.report.remaining.size() << " pairs remain";
  const double move_m = (result.x - scene.V_t0).rowwise().norm().maxCoeff();
  EXPECT_LE(move_m, largest_move_m);
  EXPECT_GT(move_m, 0);
}

}  // namespace selvage::sim::testbed
