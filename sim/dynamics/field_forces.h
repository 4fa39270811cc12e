// What acts on cloth wherever it is.
#pragma once

#include "kernel/types.h"

namespace selvage::sim {

/// On top of springs and stabilisers: acceleration gravity - (drag + quadratic_drag |v|) v. The linear drag is that of
/// still air, proportional to mass.
struct FieldForces {
  Vec3 gravity_m_s2 = Vec3::Zero();
  double drag_1_s = 0, quadratic_drag_1_m = 0;
};

}  // namespace selvage::sim
