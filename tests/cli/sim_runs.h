// Runs of `selvage sim` in a folder of their own: the fixture of its tests, and the scene that most of them start from.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/cli/run_program.h"

namespace selvage::testing {

/// A sheet that falls on a ball, which goes from one height to another, under a lid.
inline std::string scene(int frames, double ball_z, double ball_end_z) {
  return "gravity_m_s2 = [0, 0, -9.81]\n[time]\nmax_step_s = 0.0167\nmin_step_s = 0.004\nframes = " +
         std::to_string(frames) + R"(
[[cloth]]
name = "sheet"
sheet = {nx = 10, ny = 10, width_m = 0.5, height_m = 0.5}
position_m = [0.03, 0.02, 0.42]
density_kg_m2 = 0.3
stretch_n_m = 40
shear_n_m = 20
[[body]]
name = "ball"
sphere = {radius_m = 0.17, subdivisions = 2}
[[body.key]]
time_s = 0
position_m = [0, 0, )" +
         std::to_string(ball_z) + "]\n[[body.key]]\ntime_s = 0.1\nposition_m = [0, 0, " + std::to_string(ball_end_z) +
         R"(]
[[body]]
name = "lid"
box = {size_m = [1, 1, 0.1]}
position_m = [0, 0, 0.52]
)";
}

class SimCommand : public ::testing::Test {
 protected:
  testing::ProgramResult sim(const std::string& text, std::vector<std::string> options = {}) {
    spit(path("scene.toml"), text);
    options.insert(options.begin(), {"sim", path("scene.toml"), "-o", path("out")});
    return run_program(folder_, options);
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  TemporaryFolder folder_;
};

}  // namespace selvage::testing
