// The two deciders of motions against each other, millions of times: agreement_campaign FIRST_SEED CHUNKS CASES
// Prints a line of JSON for every chunk (one seed), so that a campaign may be stopped and continued with another seed.
// Ends with exit code 1 at the first chunk with a disagreement, and prints it.
#include <cstdio>
#include <cstdlib>

#include <nlohmann/json.hpp>

#include "tests/verify/agreement.h"

int main(int argc, char** argv) {
  using selvage::verify::testbed::Agreement;
  if (argc != 4) {
    std::fprintf(stderr, "usage: agreement_campaign FIRST_SEED CHUNKS CASES\n");
    return 2;
  }
  const std::uint64_t first_seed = std::strtoull(argv[1], nullptr, 10);
  const long chunks = std::strtol(argv[2], nullptr, 10);
  const int cases = std::atoi(argv[3]);
  for (long chunk = 0; chunk < chunks; ++chunk) {
    const std::uint64_t seed = first_seed + static_cast<std::uint64_t>(chunk);
    const Agreement agreement = selvage::verify::testbed::compare_deciders(seed, cases);
    nlohmann::ordered_json line = {{"seed", seed}, {"cases", cases}, {"disagreements", agreement.disagreements}};
    for (const auto& tally : agreement.classes) {
      line["classes"][tally.name] = {{"drawn", tally.drawn},           {"related", tally.related},
                                     {"touches", tally.touches},       {"inside", tally.inside},
                                     {"unfiltered", tally.unfiltered}, {"cpu_s", tally.cpu_s}};
    }
    std::printf("%s\n", line.dump().c_str());
    std::fflush(stdout);
    if (!agreement.disagreements.empty()) return 1;
  }
}
