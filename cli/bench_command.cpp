#include "cli/bench_command.h"

#include "cli/bench/bench_broad_command.h"
#include "cli/bench/bench_ccd_command.h"
#include "cli/bench/bench_methods_command.h"
#include "cli/bench/bench_queries_command.h"
#include "cli/bench/bench_sim_command.h"
#include "cli/bench/bench_stability_command.h"
#include "cli/bench/bench_verify_command.h"
#include "cli/command.h"

namespace selvage::cli {

void add_bench_command(CLI::App& program, Job& job) {
  CLI::App& bench = add_command(program, "bench", "Speed against error", "selvage bench queries data_vf.csv");
  add_bench_queries_command(bench, job);
  add_bench_ccd_command(bench, job);
  add_bench_broad_command(bench, job);
  add_bench_verify_command(bench, job);
  add_bench_methods_command(bench, job);
  add_bench_stability_command(bench, job);
  add_bench_sim_command(bench, job);
  require_one_subcommand(bench, job);
}

}  // namespace selvage::cli
