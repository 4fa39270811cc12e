// Google Benchmark of the smallest pieces of work: nanoseconds a query. `make micro`.
#include <benchmark/benchmark.h>

#include "bench/micro/workloads.h"
#include "bench/textbook.h"

namespace selvage::bench {
namespace {

const SheetWork& sheet() {
  static const SheetWork work = sheet_work(60);
  return work;
}

using Work = std::int64_t (*)(const SheetWork&);

void run(benchmark::State& state, Work work) {
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(work(sheet()));
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(sheet().queries.size()));
}

std::int64_t ask_textbook(const SheetWork& work) {
  std::int64_t alarms = 0;
  for (const MethodQuery& query : work.queries) {
    alarms +=
        (query.kind == PairKind::kVf ? textbook_vf : textbook_ee)(query.x_t0, query.x_t1, kTextbookTolerance).collides;
  }
  return alarms;
}

BENCHMARK_CAPTURE(run, textbook, ask_textbook)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, kernel_single, ask_single)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, kernel_batches, ask_in_batches)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, broad_phase, find_candidates)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(run, exact_decision, decide_exactly)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace selvage::bench

BENCHMARK_MAIN();
