#include <algorithm>
#include <cstdint>
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

void add_accuracy(plot::Figure& figure, const std::string& heading, const std::vector<bench::AccuracyRow>& rows) {
  const plot::Axis time{"processor time a frame, ms"};
  plot::Curves distance{time, {"distance to a refined run, share"}, {}}, drift{time, {"energy drift, share"}, {}};
  for (const bench::AccuracyRow& row : rows) {
    const double ms = ms_of_each(row.run.cpu_ns, row.run.frames);
    const std::string words = fmt::format(
        "{} nodes along a side, {} substeps\ndistance {:.2e}, energy drift {:.2e}\n{:.2f} ms a frame, ratio {:.2f}",
        row.nodes, row.substeps, row.distance, row.run.energy_drift, ms, row.ratio);
    distance.add(bench::solver_name(row.solver), {ms, row.distance, words});
    drift.add(bench::solver_name(row.solver), {ms, row.run.energy_drift, words});
  }
  figure.panels.emplace_back(plot::Heading{heading});
  figure.panels.emplace_back(std::move(distance));
  figure.panels.emplace_back(std::move(drift));
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
  plot::Bars bars{{"processor time a frame, ms", plot::ScaleKind::kLinear}, {"ms", "ratio", "steps"}, {}};
  for (const bench::ModuleRow& row : rows) {
    const double ms = ms_of_each(row.run.cpu_ns, row.run.frames);
    bars.bars.push_back(
        {row.added, ms, {{number_label(ms)}, {number_label(row.ratio)}, {std::to_string(row.run.steps)}}, true});
  }
  return bars;
}

void add_growth(plot::Figure& figure, const std::vector<bench::GrowthRow>& rows) {
  const plot::Axis nodes{"nodes along a side"};
  plot::Curves processor{nodes, {"processor time a step, ms"}, {}}, wall{nodes, {"wall time a step, ms"}, {}};
  for (const bench::GrowthRow& row : rows) {
    const std::string name = series_name(bench::solver_name(row.solver), row.thread_count);
    const double cpu_ms = ms_of_each(row.run.cpu_ns, row.run.steps),
                 wall_ms = ms_of_each(row.run.wall_ns, row.run.steps);
    const sim::StepPhases& phases = row.run.phases;
    const std::string words = fmt::format(
        "{} nodes along a side\n{:.1f} ms of the processor, {:.1f} ms on the wall\ndynamics {:.2f} s, collision "
        "{:.2f} s, velocity {:.2f} s on the wall",
        row.nodes, cpu_ms, wall_ms, phases.dynamics.wall_s, phases.collision.wall_s, phases.velocity.wall_s);
    processor.add(name, {static_cast<double>(row.nodes), cpu_ms, words});
    wall.add(name, {static_cast<double>(row.nodes), wall_ms, words});
  }
  figure.panels.emplace_back(plot::Heading{"Growth"});
  figure.panels.emplace_back(std::move(processor));
  figure.panels.emplace_back(std::move(wall));
}

}  // namespace

plot::Figure figure_of(const bench::SimBenchReport& report) {
  plot::Figure figure{"The simulator: time and errors", {"left and low is best"}, 2, {}};
  add_accuracy(figure, "A swinging sheet, finer steps", report.time_steps);
  add_accuracy(figure, "A swinging sheet, finer mesh and steps together", report.meshes);
  figure.panels.emplace_back(plot::Heading{"Conservation: drifts, gain and strain as shares"});
  figure.panels.emplace_back(conservation_bars(report.conservation));
  figure.panels.emplace_back(plot::Heading{"Modules, one added after another"});
  figure.panels.emplace_back(module_bars(report.modules));
  add_growth(figure, report.growth);
  return figure;
}

}  // namespace selvage::cli
