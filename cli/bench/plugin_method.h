// Somebody's collision code (fuzz/plugin/plugin.h) as one more method of `selvage bench queries` and `bench ccd`.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include <CLI/CLI.hpp>

#include "bench/ccd_bench.h"
#include "bench/file_queries.h"
#include "bench/guest_method.h"
#include "bench/query_times.h"
#include "fuzz/run/worker.h"

namespace selvage::cli {

struct PluginArguments {
  std::string library;  ///< empty: none
  double case_time_s = fuzz::kCaseSeconds;
};
/// --plugin and --case-time; `arguments` must outlive the parsing.
void add_plugin(CLI::App& bench, PluginArguments& arguments);

/// What it is and declares, without which its false alarms say little: for a line behind a table.
[[nodiscard]] std::string words_of(const bench::GuestFacts& facts);

template <typename Times>
struct PluginMeasurement {
  bench::GuestMethod<Times> method;
  std::string misbehaviour;  ///< a line for people, with the query; then the method has no figures
};

/// Asks it each query once, under the watch of a campaign, and then again for `repeat` timed passes; all in a process
/// of its own, where every answer, and loading it, may take `case_time_s`. That process takes no threads along: there
/// must be none yet. Throws io::Error: it is no plugin, as fuzz::probe_plugin() has it, or a query is none that the
/// interface admits.
[[nodiscard]] PluginMeasurement<bench::QueryTimes> measure_plugin(const PluginArguments& plugin,
                                                                  std::span<const bench::QueryFile> files, int repeat);
/// The same on the candidates of a motion, those of vertices and faces first, in their order, as a simulator would ask.
[[nodiscard]] PluginMeasurement<bench::KindTimes> measure_plugin(const PluginArguments& plugin,
                                                                 const bench::MeshMotion& motion,
                                                                 const Candidates& candidates, int repeat);

}  // namespace selvage::cli
