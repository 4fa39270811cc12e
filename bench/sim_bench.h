// The simulator: time against error, growth with the mesh, and the cost of each module.
#pragma once

#include <string>
#include <vector>

#include "bench/sim_run.h"

namespace selvage::bench {

struct SimBenchOptions {
  /// The first is the baseline; the reference is always explicit.
  std::vector<sim::Solver> solvers{sim::Solver::kExplicit};
  std::vector<int> growth_nodes{30, 60, 120, 240, 400};
  std::vector<int> thread_counts{1, 2};
  int growth_steps = 3;   ///< collision steps of each size
  int finest_mesh = 33;   ///< nodes along a side; its reference has four times the cells
  int module_nodes = 60;  ///< along a side
  int repeat = 3;         ///< runs of each short scene, >= 1; the fastest counts
};

/// `distance` is to a run whose dynamics step is a quarter of the finest one here (and whose mesh has four times the
/// cells along a side of the finest): root mean square over the vertices that both have, as a share of the sheet's
/// side.
struct AccuracyRow {
  sim::Solver solver = sim::Solver::kExplicit;
  int nodes = 0, substeps = 0;  ///< of the dynamics in a frame of 1/30 s
  double distance = 0;
  double ratio = 0;  ///< processor time a frame, to the first solver's at `kBaselineSubsteps` on the same mesh study
  SimRun run;
};
inline constexpr int kBaselineNodes = 17, kBaselineSubsteps = 64;

struct ConservationRow {
  sim::Solver solver = sim::Solver::kExplicit;
  std::string scene;  ///< meeting: momentum, energy; stretch: strain beyond the limit of 10 %
  SimRun run;
};

struct GrowthRow {
  sim::Solver solver = sim::Solver::kExplicit;
  int nodes = 0, thread_count = 1;
  SimRun run;
};

struct ModuleRow {
  std::string added;
  double ratio = 0;  ///< processor time a frame, to the first row
  SimRun run;
};

struct SimBenchReport {
  std::vector<AccuracyRow> time_steps, meshes;
  std::vector<ConservationRow> conservation;
  std::vector<GrowthRow> growth;
  std::vector<ModuleRow> modules;
};

[[nodiscard]] SimBenchReport run_sim_bench(const SimBenchOptions& options);

/// Root mean square distance of the vertices of a sheet to the same places of one with a multiple of its cells along a
/// side. REQUIRES (fine_nodes - 1) % (nodes - 1) == 0.
[[nodiscard]] double sheet_distance(const Positions& x, int nodes, const Positions& fine, int fine_nodes);

/// Schema selvage.bench.sim/1.
[[nodiscard]] std::string to_json(const SimBenchReport& report);

}  // namespace selvage::bench
