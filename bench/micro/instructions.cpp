// One workload, once, for callgrind, which counts between entry and exit of selvage_counted alone (instructions.py).
#include <cstdio>
#include <string_view>

#include "bench/micro/workloads.h"
#include "bench/timed.h"

namespace {

using selvage::bench::SheetWork;
using Work = std::int64_t (*)(const SheetWork&);

constexpr struct {
  std::string_view name;
  Work work;
} kWorkloads[] = {{"kernel", selvage::bench::ask_single},
                  {"broad_phase", selvage::bench::find_candidates},
                  {"exact_decision", selvage::bench::decide_exactly}};

}  // namespace

extern "C" [[gnu::noinline]] std::int64_t selvage_counted(Work work, const SheetWork& sheet) { return work(sheet); }

int main(int argc, char** argv) {
  for (const auto& workload : kWorkloads) {
    if (argc != 2 || workload.name != argv[1]) continue;
    const SheetWork sheet = selvage::bench::sheet_work(40);
    std::int64_t result = 0;
    selvage::bench::with_threads(1, [&] { result = selvage_counted(workload.work, sheet); });
    std::printf("%s %lld\n", argv[1], static_cast<long long>(result));
    return 0;
  }
  std::fprintf(stderr, "usage: selvage_instructions kernel|broad_phase|exact_decision\n");
  return 2;
}
