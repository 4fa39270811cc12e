// The judge of a mesh's collisions: every pair of the mesh, named by the report or not, against exact arithmetic.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernel/collisions.h"

namespace selvage::fuzz {

/// What find_collisions() was asked, and what it answered.
struct AnsweredMotion {
  const Mesh& mesh;
  const Positions &x_t0, &x_t1;
  CcdOptions options;
  const std::vector<std::uint8_t>& active;  ///< #V flags, or empty: all
  const CollisionReport& report;
};

struct CollisionsJudgement {
  std::int64_t pairs = 0;          ///< judged
  std::string failure;             ///< the first broken promise in a word, or empty
  std::vector<std::string> facts;  ///< the first pairs that break one
};
/// A pair that the report leaves out is taken as called separated (K1); the first 500 that it names, at their word (K1
/// to K3). toi_lower of all is taken as a claim about each. O(#V #F + #E^2).
[[nodiscard]] CollisionsJudgement judge(const AnsweredMotion& motion);

}  // namespace selvage::fuzz
