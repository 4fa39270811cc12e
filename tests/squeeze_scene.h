// Two boxes that close on a sheet between them.
#pragma once

#include <string>

namespace selvage::testing {

/// They touch where the hammer ends at 0.04 m, after 0.2 of 1/3 s.
inline std::string squeeze_scene_text(const std::string& policy, const std::string& hammer_end_m = "0.04") {
  return "squeeze = \"" + policy + R"("
[time]
frames = 10
max_step_s = 0.01
min_step_s = 0.004
[[cloth]]
sheet = {nx = 4, ny = 4, width_m = 0.3, height_m = 0.3}
density_kg_m2 = 0.3
stretch_n_m = 40
shear_n_m = 20
[[body]]
name = "anvil"
box = {size_m = [1, 1, 0.1]}
position_m = [0, 0, -0.06]
[[body]]
name = "hammer"
box = {size_m = [1, 1, 0.1]}
[[body.key]]
time_s = 0
position_m = [0, 0, 0.08]
[[body.key]]
time_s = 0.2
position_m = [0, 0, )" +
         hammer_end_m + "]\n";
}

}  // namespace selvage::testing
