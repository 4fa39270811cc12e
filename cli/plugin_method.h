// Somebody's collision code (fuzz/plugin/plugin.h) as one more method of `selvage bench queries`.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bench/file_queries.h"
#include "bench/guest_method.h"

namespace selvage::cli {

struct PluginMeasurement {
  bench::GuestMethod method;
  std::string misbehaviour;  ///< a line for people, with the query; then the method has no figures
};

/// Asks it each query once, under the watch of a campaign, and then again for `repeat` timed passes; all in a process
/// of its own, where every answer, and loading it, may take `case_seconds`. Throws io::Error: it is no plugin, as
/// fuzz::probe_plugin() has it, or a query is none that the interface admits.
[[nodiscard]] PluginMeasurement measure_plugin(const std::filesystem::path& library,
                                               std::span<const bench::QueryFile> files, int repeat,
                                               double case_seconds);

}  // namespace selvage::cli
