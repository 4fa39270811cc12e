// The entry points that libFuzzer defines and that AFL++'s driver calls too. One program a target:
// SELVAGE_FUZZ_TARGET is its name.
#include <cstdio>
#include <cstdlib>

#include <oneapi/tbb/global_control.h>

#include "fuzz/harness/fuzz_target.h"

namespace {

selvage::fuzz::FuzzTarget& target() {
  static const auto one = selvage::fuzz::fuzz_target(SELVAGE_FUZZ_TARGET);
  return *one;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  // AFL++ forks behind this, and a fork takes no thread along; coverage is the same each time without them.
  static const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  target().prepare();
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string failure = target().run({data, size}).failure;
  if (!failure.empty()) {
    std::fprintf(stderr, "selvage: %s: %s\n", target().name().c_str(), failure.c_str());
    std::abort();  // what both engines call a crash
  }
  return 0;
}
