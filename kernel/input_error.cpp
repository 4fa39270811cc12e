#include "kernel/input_error.h"

namespace selvage {

const char* describe(InputError error) {
  switch (error) {
    case InputError::kNone:
      return "no error";
    case InputError::kSizeMismatch:
      return "the arrays differ in size; pass #V rows of positions for every time, and an entry a vertex of all else";
    case InputError::kNotFinite:
      return "a coordinate is NaN or infinite; check the simulation that produced it";
    case InputError::kTooLarge:
      return "a coordinate exceeds kMaxCoordinate, or a scripted one the largest float32; choose a larger length unit";
    case InputError::kIndexOutOfRange:
      return "a face index is negative or not below the vertex count";
    case InputError::kRepeatedVertex:
      return "a face names a vertex twice; remove the face";
    case InputError::kTooManyFaces:
      return "three times the face count exceeds 2^31 - 1; split the mesh";
    case InputError::kBadTolerance:
      return "the tolerance is negative, NaN or infinite; pass a length of at least 0";
    case InputError::kBadOption:
      return "a collision option, or one of the contact surfaces, is NaN or outside its range; the ranges stand beside "
             "the options";
    case InputError::kBadMass:
      return "an inverse mass is negative, NaN or infinite, or not 0 on a body; pass 0 for every scripted vertex";
    case InputError::kBadTimeStep:
      return "the time step is not a positive finite number of seconds; choose the step from the frame rate";
    case InputError::kOffLattice:
      return "a starting position is no float32 number; round the first state before the first float32 step";
    case InputError::kBadSurfaces:
      return "the contact surfaces do not fit the mesh; give every vertex the number of one of `properties`, the same "
             "to all three of a face, and name rest pairs of the mesh whose features share no vertex";
    case InputError::kBadContact:
      return "a held contact is none of this mesh, or not as it was met; give back what a step from the same positions "
             "has met";
    case InputError::kBadBodies:
      return "a body's number is below -1, the first pin's below 0, or the squeeze policy none that there is; number "
             "bodies from 0, with -1 for cloth";
    case InputError::kInUse:
      return "another call on the same object has not returned yet; make one object for each thread";
  }
  return "unknown error";
}

}  // namespace selvage
