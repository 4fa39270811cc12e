#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "bench/sim_scenes.h"
#include "cli/bench/bench_figures.h"
#include "cli/bench/series_name.h"
#include "cli/plot/scale.h"

namespace selvage::cli {

using plot::number_label;

namespace {

double ms_of_each(double ns, std::int64_t count) {
  return ns * 1e-6 / static_cast<double>(std::max<std::int64_t>(1, count));
}

/// One study of accuracy: what is refined, and its rows.
struct Study {
  std::string heading, refined;
  double (*size)(const bench::AccuracyRow& row);  ///< of what is refined
  bool has_guide;                                 ///< of an error of second order
  const std::vector<bench::AccuracyRow>& rows;
};

double step_ms(const bench::AccuracyRow& row) { return 1000 / bench::kFramesPerSecond / row.substeps; }
double edge_mm(const bench::AccuracyRow& row) { return 1000 * bench::kSwingSide / (row.nodes - 1); }

void add_accuracy(plot::Figure& figure, const Study& study) {
  const plot::Axis time{"time a frame, multiple (cpu)"}, error{"distance to a refined run, share"};
  plot::Curves refinement{{study.refined}, error, {}}, distance{time, error, {}},
      drift{time, {"energy drift, share"}, {}};
  for (const bench::AccuracyRow& row : study.rows) {
    const double ms = ms_of_each(row.run.cpu_ns, row.run.frames);
    const std::string words = fmt::format(
        "{} nodes along a side, {} substeps\ndistance {:.2e}, energy drift {:.2e}\n{:.2f} ms a frame, ratio {:.2f}",
        row.nodes, row.substeps, row.distance, row.run.energy_drift, ms, row.ratio);
    const std::string solver = bench::solver_name(row.solver);
    refinement.add(solver, {study.size(row), row.distance, words});
    distance.add(solver, {row.ratio, row.distance, words});
    drift.add(solver, {row.ratio, row.run.energy_drift, words});
  }
  if (study.has_guide) {
    const bench::AccuracyRow& finest = *std::ranges::min_element(study.rows, {}, study.size);
    for (const double times : {1.0, 16.0}) {  // above what was measured
      refinement.add("second order", {times * study.size(finest), 3 * times * times * finest.distance, ""},
                     plot::Look::kGuide);
    }
  }
  figure.panels.emplace_back(plot::Heading{study.heading});
  for (plot::Curves* curves : {&refinement, &distance, &drift}) figure.panels.emplace_back(std::move(*curves));
}

plot::Bars conservation_bars(const std::vector<bench::ConservationRow>& rows) {
  plot::Bars bars{{"processor time a frame, ms", plot::ScaleKind::kLinear},
                  {"ms", "contacts", "momentum", "angular m.", "energy+", "strain"},
                  {}};
  for (const bench::ConservationRow& row : rows) {
    const double ms = ms_of_each(row.run.cpu_ns, row.run.frames);
    bars.bars.push_back({fmt::format("{}, {}", row.scene, bench::solver_name(row.solver)),
                         ms,
                         {{number_label(ms)},
                          {std::to_string(row.run.contacts)},
                          {number_label(row.run.momentum_drift)},
                          {number_label(row.run.angular_momentum_drift)},
                          {number_label(row.run.energy_gain)},
                          {number_label(row.run.strain)}},
                         true});
  }
  return bars;
}

plot::Bars module_bars(const std::vector<bench::ModuleRow>& rows) {
  plot::Bars bars{{"processor time a frame, multiple of the first row's", plot::ScaleKind::kLinear},
                  {"multiple", "ms", "steps"},
                  {}};
  double before = 0;
  for (const bench::ModuleRow& row : rows) {
    const double ms = ms_of_each(row.run.cpu_ns, row.run.frames);
    bars.bars.push_back({row.added,
                         row.ratio,
                         {{fmt::format("{:.2f}", row.ratio)}, {number_label(ms)}, {std::to_string(row.run.steps)}},
                         true,
                         before});
    before = row.ratio;
  }
  return bars;
}

/// Which phase takes the time: of the first solver, on the first number of threads.
plot::Curves phases_panel(const std::vector<bench::GrowthRow>& rows) {
  plot::Curves curves{
      {"nodes along a side"}, {"share of the step", plot::ScaleKind::kLinear, std::nullopt, {0, 1}}, {}};
  for (const bench::GrowthRow& row : rows) {
    if (row.solver != rows.front().solver || row.thread_count != rows.front().thread_count) continue;
    const sim::StepPhases& phases = row.run.phases;
    const std::pair<const char*, double> parts[] = {{"dynamics", phases.dynamics.wall_s},
                                                    {"collision", phases.collision.wall_s},
                                                    {"velocity", phases.velocity.wall_s}};
    double sum_s = 0;
    for (const auto& [name, wall_s] : parts) sum_s += wall_s;
    for (const auto& [name, wall_s] : parts) {
      curves.add(name, {static_cast<double>(row.nodes), wall_s / sum_s,
                        fmt::format("{} nodes along a side: {:.2f} s on the wall", row.nodes, wall_s)});
    }
  }
  return curves;
}

void add_growth(plot::Figure& figure, const std::vector<bench::GrowthRow>& rows) {
  const plot::Axis nodes{"nodes along a side"};
  plot::Curves processor{nodes, {"time a step and vertex, us (cpu)"}, {}},
      gain{nodes,
           {fmt::format("times as fast as {} (wall)", threads_name(rows.front().thread_count)),
            plot::ScaleKind::kLinear, 1},
           {}};
  for (const bench::GrowthRow& row : rows) {
    const std::string name = series_name(bench::solver_name(row.solver), row.thread_count);
    const double cpu_ms = ms_of_each(row.run.cpu_ns, row.run.steps),
                 wall_ms = ms_of_each(row.run.wall_ns, row.run.steps);
    const sim::StepPhases& phases = row.run.phases;
    const std::string words = fmt::format(
        "{} nodes along a side\n{:.1f} ms of the processor, {:.1f} ms on the wall\ndynamics {:.2f} s, collision "
        "{:.2f} s, velocity {:.2f} s on the wall",
        row.nodes, cpu_ms, wall_ms, phases.dynamics.wall_s, phases.collision.wall_s, phases.velocity.wall_s);
    processor.add(name, {static_cast<double>(row.nodes), 1000 * cpu_ms / static_cast<double>(row.run.vertices), words});
    const auto is_first = [&](const bench::GrowthRow& other) {
      return other.solver == row.solver && other.nodes == row.nodes;
    };
    const bench::GrowthRow& first = *std::ranges::find_if(rows, is_first);
    gain.add(name, {static_cast<double>(row.nodes), first.run.wall_ns / row.run.wall_ns, words});
  }
  figure.panels.emplace_back(
      plot::Heading{fmt::format("Growth with the mesh, and which phase takes the time ({}, {})",
                                bench::solver_name(rows.front().solver), threads_name(rows.front().thread_count))});
  for (plot::Curves* curves : {&processor, &gain}) figure.panels.emplace_back(std::move(*curves));
  figure.panels.emplace_back(phases_panel(rows));
}

}  // namespace

plot::Figure figure_of(const bench::SimBenchReport& report) {
  plot::Figure figure{
      "The simulator: time and errors",
      {"left and low is best; distances are shares of the sheet's side, drifts of the largest kinetic energy",
       fmt::format("multiple: of the processor time of the first solver, {} nodes a side, {} steps a frame",
                   bench::kBaselineNodes, bench::kBaselineSubsteps),
       "modules: dark is what a row adds to the one above it"},
      3,
      {}};
  add_accuracy(figure, {"A swinging sheet, finer steps", "step of the dynamics, ms", step_ms, true, report.time_steps});
  add_accuracy(figure, {"A swinging sheet, finer mesh and steps together", "edge of the mesh, mm", edge_mm, false,
                        report.meshes});
  add_growth(figure, report.growth);
  figure.panels.emplace_back(plot::Heading{"Modules, one added after another"});
  figure.panels.emplace_back(module_bars(report.modules));
  figure.panels.emplace_back(plot::Heading{"Conservation: drifts, gain and strain as shares"});
  figure.panels.emplace_back(conservation_bars(report.conservation));
  return figure;
}

}  // namespace selvage::cli
