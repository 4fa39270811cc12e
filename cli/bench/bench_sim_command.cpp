#include "cli/bench/bench_sim_command.h"

#include <memory>

#include <fmt/format.h>

#include "bench/sim_bench.h"
#include "bench/sim_scenes.h"
#include "cli/answer/result.h"
#include "cli/arguments/choice.h"
#include "cli/arguments/list_option.h"
#include "cli/arguments/number_check.h"
#include "cli/arguments/output_check.h"
#include "cli/bench/bench_figures.h"
#include "cli/bench/bench_outputs.h"
#include "cli/command.h"

namespace selvage::cli {
namespace {

struct SimBenchArguments {
  BenchOutputs outputs;
  bench::SimBenchOptions options;
};

double ms_a(const bench::SimRun& run, std::int64_t count) {
  return run.cpu_ns * 1e-6 / static_cast<double>(std::max<std::int64_t>(1, count));
}

std::string table(const char* title, const std::vector<bench::AccuracyRow>& rows) {
  std::string text = fmt::format("{}\n  {:<10} {:>6} {:>9} {:>10} {:>13} {:>10} {:>8}\n", title, "solver", "nodes",
                                 "substeps", "distance", "energy drift", "ms/frame", "ratio");
  for (const bench::AccuracyRow& row : rows) {
    text += fmt::format("  {:<10} {:>6} {:>9} {:>10.2e} {:>13.2e} {:>10.2f} {:>8.2f}\n", bench::solver_name(row.solver),
                        row.nodes, row.substeps, row.distance, row.run.energy_drift, ms_a(row.run, row.run.frames),
                        row.ratio);
  }
  return text;
}

std::string tables(const bench::SimBenchReport& report) {
  std::string text = table("a swinging sheet, finer steps", report.time_steps);
  text += table("a swinging sheet, finer mesh and steps together", report.meshes);
  text += fmt::format("conservation\n  {:<10} {:<8} {:>9} {:>9} {:>12} {:>9} {:>9} {:>10}\n", "solver", "scene",
                      "contacts", "momentum", "angular m.", "energy+", "strain", "ms/frame");
  for (const bench::ConservationRow& row : report.conservation) {
    text +=
        fmt::format("  {:<10} {:<8} {:>9} {:>9.1e} {:>12.1e} {:>9.1e} {:>9.4f} {:>10.2f}\n",
                    bench::solver_name(row.solver), row.scene, row.run.contacts, row.run.momentum_drift,
                    row.run.angular_momentum_drift, row.run.energy_gain, row.run.strain, ms_a(row.run, row.run.frames));
  }
  text +=
      fmt::format("modules, one added after another\n  {:<32} {:>10} {:>8} {:>7}\n", "", "ms/frame", "ratio", "steps");
  for (const bench::ModuleRow& row : report.modules) {
    text += fmt::format("  {:<32} {:>10.2f} {:>8.3f} {:>7}\n", row.added, ms_a(row.run, row.run.frames), row.ratio,
                        row.run.steps);
  }
  text += fmt::format("growth\n  {:<10} {:>6} {:>8} {:>12} {:>13} {:>9} {:>10} {:>9}\n", "solver", "nodes", "threads",
                      "cpu ms/step", "wall ms/step", "dynamics", "collision", "velocity");
  for (const bench::GrowthRow& row : report.growth) {
    const double wall_s = row.run.wall_ns * 1e-9;
    text += fmt::format("  {:<10} {:>6} {:>8} {:>12.1f} {:>13.1f} {:>8.0f}% {:>9.0f}% {:>8.0f}%\n",
                        bench::solver_name(row.solver), row.nodes, row.thread_count, ms_a(row.run, row.run.steps),
                        row.run.wall_ns * 1e-6 / static_cast<double>(row.run.steps),
                        100 * row.run.phases.dynamics.wall_s / wall_s, 100 * row.run.phases.collision.wall_s / wall_s,
                        100 * row.run.phases.velocity.wall_s / wall_s);
  }
  return text;
}

ExitCode bench_sim(const SimBenchArguments& arguments) {
  require_outputs({}, arguments.outputs.files());
  const bench::SimBenchReport report = bench::run_sim_bench(arguments.options);
  print_result(tables(report), arguments.outputs.files());
  print_result(
      fmt::format("processor time of all threads, best of {} runs (growth: one run)\n", arguments.options.repeat),
      arguments.outputs.files());
  if (!arguments.outputs.json.empty()) write_report(arguments.outputs.json, bench::to_json(report));
  if (!arguments.outputs.svg.empty()) write_report(arguments.outputs.svg, plot::to_svg(figure_of(report)));
  return ExitCode::kClean;
}

}  // namespace

void add_bench_sim_command(CLI::App& bench, Job& job) {
  CLI::App& sim = add_command(
      bench, "sim",
      "The simulator: time against distance to a refined run, drift of energy and momentum, strain over the "
      "limit, growth with the mesh, and the cost of each module.",
      "selvage bench sim --growth 30,60,120 --json out.json");
  const auto arguments = std::make_shared<SimBenchArguments>();
  bench::SimBenchOptions& options = arguments->options;
  add_choices(sim, "--solvers", options.solvers,
              {{bench::solver_name(sim::Solver::kExplicit), sim::Solver::kExplicit},
               {bench::solver_name(sim::Solver::kImplicit), sim::Solver::kImplicit}},
              "explicit (default), implicit, or a list of them with commas; the first is the baseline");
  add_list(sim, "--growth", options.growth_nodes, "Nodes along a side of the sheets that grow")
      ->check(whole_between(2, 2000))
      ->capture_default_str();
  add_list(sim, "--threads", options.thread_counts, "Numbers of threads, for growth")
      ->check(whole_between(1, 1024))
      ->capture_default_str();
  sim.add_option("--steps", options.growth_steps, "Collision steps of each sheet that grows")
      ->check(whole_between(1, 1000))
      ->capture_default_str();
  sim.add_option("--finest-mesh", options.finest_mesh, "Nodes along a side of the finest mesh that swings")
      ->check(whole_number())
      ->check(CLI::IsMember({17, 33, 65}))
      ->capture_default_str();
  sim.add_option("--module-nodes", options.module_nodes, "Nodes along a side of the sheet that gets modules")
      ->check(whole_between(2, 1000))
      ->capture_default_str();
  sim.add_option("--repeat", options.repeat, "Runs of each short scene")
      ->check(whole_between(1, 1000))
      ->capture_default_str();
  add_outputs(sim, arguments->outputs);
  sim.callback([arguments, &job] { job = [arguments] { return bench_sim(*arguments); }; });
}

}  // namespace selvage::cli
