#include "cli/bench/bench_outputs.h"

namespace selvage::cli {

void add_outputs(CLI::App& bench, BenchOutputs& outputs) {
  bench.add_option("--json", outputs.json, "Also write the report to this file");
  bench.add_option("--svg", outputs.svg, "Also draw the results, as a picture for browsers, into this file");
}

}  // namespace selvage::cli
