#include "kernel/mesh.h"

namespace selvage {

const char* describe(InputError error) {
  switch (error) {
    case InputError::kNone: return "no error";
    case InputError::kSizeMismatch: return "the arrays differ in size; pass #V rows of positions for every time";
    case InputError::kNotFinite: return "a coordinate is NaN or infinite; check the simulation that produced it";
    case InputError::kTooLarge: return "a coordinate exceeds kMaxCoordinate; choose a smaller length unit";
    case InputError::kIndexOutOfRange: return "a face index is negative or not below the vertex count";
    case InputError::kRepeatedVertex: return "a face names a vertex twice; remove the face";
    case InputError::kBadTolerance: return "the tolerance is negative, NaN or infinite; pass a length of at least 0";
  }
  return "unknown error";
}

}  // namespace selvage
