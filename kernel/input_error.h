// What is wrong with what a caller passed.
#pragma once

#include <cstdint>

namespace selvage {

/// What can be wrong with what the caller passed; describe() says it in words.
enum class InputError : std::uint8_t {
  kNone,
  kSizeMismatch,
  kNotFinite,
  kTooLarge,
  kIndexOutOfRange,
  kRepeatedVertex,
  kTooManyFaces,
  kBadTolerance,
  // Of a collision step (sim/collision_step.h) alone:
  kBadOption,
  kBadMass,
  kBadTimeStep,
  kOffLattice,
  kBadSurfaces,
  kBadContact,
  kBadBodies,
  kInUse
};

/// One sentence for a person, with the remedy.
[[nodiscard]] const char* describe(InputError error);

}  // namespace selvage
