// same_bits: one hash of the kernel's answers, for every SIMD target of this machine and 1 to 8 threads (K7).
//   Prints "hash <of queries> <of whole-mesh calls>" and what it was computed with; exit code 1 if anything but the
//   hash differs within the run.
#include <cinttypes>
#include <cstdio>
#include <string>

#include "kernel/fp_env.h"
#include "tests/kernel/with_threads.h"
#include "tests/same_bits/hash.h"
#include "tests/vector_units.h"

namespace {

using selvage::testing::Hash;

/// Counts the runs whose hash is not that of the first.
class Comparison {
 public:
  void add(const char* target, int thread_count, std::uint64_t hash) {
    if (run_count_++ == 0) first_ = hash;
    if (hash == first_) return;
    ++difference_count_;
    std::printf("differs: %s, %d threads: %016" PRIx64 "\n", target, thread_count, hash);
  }
  [[nodiscard]] std::uint64_t first() const { return first_; }
  [[nodiscard]] int run_count() const { return run_count_; }
  [[nodiscard]] bool all_equal() const { return difference_count_ == 0; }

 private:
  std::uint64_t first_ = 0;
  int run_count_ = 0, difference_count_ = 0;
};

template <typename Add>
std::uint64_t hash_of(const Add& add) {
  Hash hash;
  add(hash);
  return hash.value();
}

}  // namespace

int main() {
  using namespace selvage::testing;
  // For the questions: what g++ links to -funsafe-math-optimizations flushes subnormal numbers from the start.
  const selvage::FpEnvGuard guard;
  const std::uint64_t queries = hash_of(add_query_answers);  // scalar code, run by the thread that asks
  Comparison meshes;
  std::string targets;
  selvage::testing::on_every_vector_unit([&](const char* name) {
    targets += std::string(" ") + name;
    // Every number of threads with the first target, one and many with the others: they share the code for threads.
    for (const int thread_count : meshes.run_count() < 8 ? std::vector{1, 2, 3, 4, 5, 6, 7, 8} : std::vector{1, 8}) {
      with_threads(thread_count, [&] { meshes.add(name, thread_count, hash_of(add_mesh_answers)); });
    }
  });
  std::printf("hash %016" PRIx64 " %016" PRIx64 "\n%d runs, 1 to 8 threads, targets%s\n", queries, meshes.first(),
              meshes.run_count(), targets.c_str());
  return meshes.all_equal() && meshes.run_count() > 0 ? 0 : 1;
}
