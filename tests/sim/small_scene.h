// A small scene that has everything: a sheet that falls on a moving ball over a floor.
#pragma once

#include <string>

#include "sim/scene/scene_reader.h"
#include "tests/temporary_folder.h"

namespace selvage::testing {

/// 14 by 14 vertices; in contact from about 0.15 s on. `extra` goes to the top of the file.
inline std::string small_scene_text(int frames, const std::string& extra = "", const std::string& collision = "") {
  return extra +
         "gravity_m_s2 = [0, 0, -9.81]\n[time]\nframes_per_s = 30\nmax_step_s = 0.0167\nmin_step_s = 0.004\nframes = " +
         std::to_string(frames) + "\n[collision]\nthickness_m = 0.005\nfriction_static = 0.4\n" + collision + R"(
[[cloth]]
name = "sheet"
sheet = {nx = 14, ny = 14, width_m = 0.7, height_m = 0.7}
position_m = [0.03, 0.02, 0.47]
rotation_deg = [0, 0, 20]
density_kg_m2 = 0.3
stretch_n_m = 40
shear_n_m = 20
bend_n_m = 0.5
damping_ratio = 0.1
[[body]]
name = "ball"
sphere = {radius_m = 0.17, subdivisions = 2}
[[body.key]]
time_s = 0.2
position_m = [0, 0, 0.2]
[[body.key]]
time_s = 1
position_m = [0.3, 0.1, 0.2]
rotation_deg = [0, 90, 30]
[[body]]
name = "floor"
sheet = {nx = 2, ny = 2, width_m = 6, height_m = 6}
)";
}

/// Scenes are read from files, because a checkpoint belongs to the file's bytes.
inline sim::Scene write_and_read_scene(const std::filesystem::path& file, const std::string& text) {
  spit(file, text);
  return sim::read_scene(file);
}

}  // namespace selvage::testing
