// A collision step as a case: a surface, where it is and where it is to go, and what the step is told.
#pragma once

#include "fuzz/kept/mesh_case.h"
#include "fuzz/oracle/step_oracle.h"

namespace selvage::fuzz {

[[nodiscard]] const MeshKind& step_kind();
/// The step of this world from x_t0 to the candidate.
[[nodiscard]] MeshCase step_case(const StepWorld& world, const Positions& x_t0, const Positions& candidate);
/// The same for a step under test that is not ours.
[[nodiscard]] Retrial retry_step(const MeshCase& kept, const StepFunction& step);

}  // namespace selvage::fuzz
