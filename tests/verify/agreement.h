// The two exact deciders of motions side by side on generated queries of every class, with the relations that any right
// answer obeys asked of both. Used by a test with few cases and by a campaign with millions (agreement_campaign.cpp).
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace selvage::verify::testbed {

struct ClassTally {
  std::string name;
  std::int64_t drawn = 0;       ///< queries decided by both, drawn or planted
  std::int64_t related = 0;     ///< queries decided by both, made from a drawn one: reversed, relabelled, halved
  std::int64_t touches = 0;     ///< of all of these, how many touch,
  std::int64_t inside = 0;      ///< at first inside (0,1);
  std::int64_t unfiltered = 0;  ///< and where the first decider's filter did not suffice
  double cpu_s = 0;
};

struct Agreement {
  std::vector<ClassTally> classes;
  std::vector<std::string> disagreements;  ///< which decider or relation, and the bits; the first of every class
};

/// `cases` drawn motions for every class on a lattice, fewer for those that cost more; each motion is a vertex-face, an
/// edge-edge and a self query. Depends on the seed and the number alone, but for the times.
[[nodiscard]] Agreement compare_deciders(std::uint64_t seed, int cases);

}  // namespace selvage::verify::testbed
