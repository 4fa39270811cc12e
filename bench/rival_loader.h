// Loads the rivals that were built beside the program.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/rivals/frame_rival.h"
#include "bench/rivals/rival.h"

namespace selvage::bench {

struct LoadedRival {
  std::string name;                                                ///< cgal, embree
  std::string absent;                                              ///< why it is not here; empty if it is
  std::function<std::unique_ptr<Rival>(int thread_count)> create;  ///< REQUIRES that it is here
};

/// All rivals there are, in a fixed order. They stay loaded.
[[nodiscard]] std::vector<LoadedRival> load_rivals(const std::filesystem::path& folder);

struct LoadedFrameRival {
  std::string absent;  ///< as in LoadedRival
  std::function<std::unique_ptr<FrameRival>()> create;
};

/// CGAL's self_intersections.
[[nodiscard]] LoadedFrameRival load_frame_rival(const std::filesystem::path& folder);

/// Where a build leaves them, seen from the running program: ../bench.
[[nodiscard]] std::filesystem::path rivals_beside_program();

}  // namespace selvage::bench
