#include <nlohmann/json.hpp>

#include "bench/sim_bench.h"
#include "bench/sim_scenes.h"

namespace selvage::bench {
namespace {

using Json = nlohmann::ordered_json;

/// What every row says of its run, after the columns that name it.
Json with_run(Json row, const SimRun& run) {
  const auto of = [](double ns, std::int64_t count) { return count > 0 ? ns * 1e-6 / static_cast<double>(count) : 0; };
  row.update({{"vertices", run.vertices},
              {"fine_vertices", run.fine_vertices},
              {"frames", run.frames},
              {"steps", run.steps},
              {"ms_a_frame", of(run.cpu_ns, run.frames)},
              {"ms_a_step", of(run.cpu_ns, run.steps)},
              {"wall_ms_a_step", of(run.wall_ns, run.steps)},
              {"contacts", run.contacts},
              {"fail_safe_vertices", run.fail_safe_vertices},
              {"energy_drift", run.energy_drift},
              {"energy_gain", run.energy_gain},
              {"momentum_drift", run.momentum_drift},
              {"angular_momentum_drift", run.angular_momentum_drift},
              {"strain", run.strain},
              {"wall_s",
               {{"dynamics", run.phases.dynamics.wall_s},
                {"collision", run.phases.collision.wall_s},
                {"velocity", run.phases.velocity.wall_s}}}});
  return row;
}

Json json_of(const std::vector<AccuracyRow>& rows) {
  Json list = Json::array();
  for (const AccuracyRow& row : rows) {
    list.push_back(with_run({{"solver", solver_name(row.solver)},
                             {"nodes", row.nodes},
                             {"substeps", row.substeps},
                             {"distance", row.distance},
                             {"ratio", row.ratio}},
                            row.run));
  }
  return list;
}

}  // namespace

std::string to_json(const SimBenchReport& report) {
  Json conservation = Json::array(), growth = Json::array(), modules = Json::array();
  for (const ConservationRow& row : report.conservation) {
    conservation.push_back(with_run({{"solver", solver_name(row.solver)}, {"scene", row.scene}}, row.run));
  }
  for (const GrowthRow& row : report.growth) {
    growth.push_back(
        with_run({{"solver", solver_name(row.solver)}, {"nodes", row.nodes}, {"threads", row.thread_count}}, row.run));
  }
  for (const ModuleRow& row : report.modules) {
    modules.push_back(with_run({{"added", row.added}, {"ratio", row.ratio}}, row.run));
  }
  const Json json = {{"schema", "selvage.bench.sim/1"},
                     {"baseline", {{"nodes", kBaselineNodes}, {"substeps", kBaselineSubsteps}}},
                     {"time_steps", json_of(report.time_steps)},
                     {"meshes", json_of(report.meshes)},
                     {"conservation", conservation},
                     {"modules", modules},
                     {"growth", growth}};
  return json.dump(2) + "\n";
}

}  // namespace selvage::bench
