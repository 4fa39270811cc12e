// What a velocity's implicit half step asks of springs and stabilisers.
#pragma once

namespace selvage::sim {

/// How much of each matrix there is in B, which maps velocities to the impulses that oppose them: damping over a time,
/// and stiffness where velocities displace the ends.
struct ImpulseShares {
  double damping_s = 0, stiffness_s2 = 0;
};

}  // namespace selvage::sim
