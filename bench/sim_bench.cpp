#include "bench/sim_bench.h"

#include <algorithm>
#include <cmath>

#include "bench/sim_scenes.h"
#include "bench/timed.h"

namespace selvage::bench {
namespace {

/// The finest step of either solver; implicit ones begin at one a frame, explicit ones where they are stable.
constexpr int kFinestSubsteps = 256, kFirstExplicitSubsteps = 64;

/// The fastest of some runs, which all end in the same bits.
SimRun fastest(const sim::Scene& scene, int repeat) {
  SimRun best = run_simulation(scene);
  for (int i = 1; i < repeat; ++i) {
    SimRun run = run_simulation(scene);
    if (run.cpu_ns < best.cpu_ns) best = std::move(run);
  }
  return best;
}

double ns_a_frame(const SimRun& run) { return run.cpu_ns / static_cast<double>(std::max<std::int64_t>(1, run.frames)); }

void set_ratios(std::vector<AccuracyRow>& rows) {
  const auto baseline = std::find_if(rows.begin(), rows.end(), [](const AccuracyRow& row) {
    return row.nodes == kBaselineNodes && row.substeps == kBaselineSubsteps;
  });
  const double baseline_ns = ns_a_frame(baseline->run);
  for (AccuracyRow& row : rows) row.ratio = ns_a_frame(row.run) / baseline_ns;
}

void study_time_steps(const SimBenchOptions& options, SimBenchReport& report) {
  const SimRun reference = run_simulation(swing_scene(sim::Solver::kExplicit, kBaselineNodes, 4 * kFinestSubsteps));
  for (const sim::Solver solver : options.solvers) {
    for (int substeps = solver == sim::Solver::kExplicit ? kFirstExplicitSubsteps : 1; substeps <= kFinestSubsteps;
         substeps *= 2) {
      AccuracyRow row{solver,   kBaselineNodes,
                      substeps, 0,
                      0,        fastest(swing_scene(solver, kBaselineNodes, substeps), options.repeat)};
      row.distance = sheet_distance(row.run.x, row.nodes, reference.x, row.nodes) / kSwingSide;
      report.time_steps.push_back(std::move(row));
    }
  }
  set_ratios(report.time_steps);
}

/// Mesh and step are refined together.
void study_meshes(const SimBenchOptions& options, SimBenchReport& report) {
  const auto substeps_of = [](int nodes) { return kBaselineSubsteps * (nodes - 1) / (kBaselineNodes - 1); };
  const int fine_nodes = 4 * (options.finest_mesh - 1) + 1;
  const SimRun reference = run_simulation(swing_scene(sim::Solver::kExplicit, fine_nodes, substeps_of(fine_nodes)));
  for (const sim::Solver solver : options.solvers) {
    for (int nodes = 9; nodes <= options.finest_mesh; nodes = 2 * nodes - 1) {
      AccuracyRow row{solver, nodes, substeps_of(nodes),
                      0,      0,     fastest(swing_scene(solver, nodes, substeps_of(nodes)), options.repeat)};
      row.distance = sheet_distance(row.run.x, nodes, reference.x, fine_nodes) / kSwingSide;
      report.meshes.push_back(std::move(row));
    }
  }
  set_ratios(report.meshes);
}

void study_growth(const SimBenchOptions& options, SimBenchReport& report) {
  for (const sim::Solver solver : options.solvers) {
    for (const int nodes : options.growth_nodes) {
      const sim::Scene scene = drape_scene(solver, nodes);
      for (const int threads : options.thread_counts) {
        GrowthRow& row = report.growth.emplace_back(GrowthRow{solver, nodes, threads, {}});
        with_threads(threads, [&] { row.run = run_simulation(scene, {options.growth_steps, 0}); });
      }
    }
  }
}

void study_modules(const SimBenchOptions& options, SimBenchReport& report) {
  const std::vector<ModuleScene> scenes = module_scenes(options.module_nodes);
  for (const ModuleScene& scene : scenes) report.modules.push_back({scene.added, 0, {}});
  for (int pass = 0; pass < options.repeat; ++pass) {  // in turns, so that what else the machine does meets all alike
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      SimRun run = run_simulation(scenes[i].scene, {.subdivision_levels = scenes[i].subdivision_levels});
      if (pass == 0 || run.cpu_ns < report.modules[i].run.cpu_ns) report.modules[i].run = std::move(run);
    }
  }
  for (ModuleRow& row : report.modules) row.ratio = ns_a_frame(row.run) / ns_a_frame(report.modules.front().run);
}

}  // namespace

double sheet_distance(const Positions& x, int nodes, const Positions& fine, int fine_nodes) {
  const int stride = (fine_nodes - 1) / (nodes - 1);
  double sum = 0;
  for (int j = 0; j < nodes; ++j) {
    for (int i = 0; i < nodes; ++i) {
      sum += (x.row(j * nodes + i) - fine.row((j * fine_nodes + i) * stride)).squaredNorm();
    }
  }
  return std::sqrt(sum / (nodes * nodes));
}

SimBenchReport run_sim_bench(const SimBenchOptions& options) {
  SimBenchReport report;
  with_threads(1, [&] {
    study_time_steps(options, report);
    study_meshes(options, report);
    for (const sim::Solver solver : options.solvers) {
      report.conservation.push_back({solver, "meeting", fastest(meeting_scene(solver), options.repeat)});
      report.conservation.push_back({solver, "stretch", fastest(stretch_scene(solver), options.repeat)});
    }
    study_modules(options, report);
  });
  study_growth(options, report);
  return report;
}

}  // namespace selvage::bench
