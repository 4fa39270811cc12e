// Where the time of a step goes, phase by phase. Measured and reported; no decision depends on it.
#pragma once

#include <chrono>
#include <ctime>

namespace selvage::sim {

struct PhaseTime {
  double wall_s = 0;
  double cpu_s = 0;  ///< of the whole process: what the machine gives to others does not count
  PhaseTime& operator+=(const PhaseTime& other) {
    wall_s += other.wall_s;
    cpu_s += other.cpu_s;
    return *this;
  }
};

/// The phases of the collision step (paper, sections 6 and 7).
struct CollisionPhases {
  PhaseTime proximity;  ///< pairs within reach (contact_reach.h) at the start
  PhaseTime repulsion;  ///< their repulsions and friction
  PhaseTime search;     ///< the first search for collisions of the whole mesh
  PhaseTime response;   ///< impulses, impact zones and fail-safe, with the searches that each round needs
  CollisionPhases& operator+=(const CollisionPhases& other) {
    proximity += other.proximity;
    repulsion += other.repulsion;
    search += other.search;
    response += other.response;
    return *this;
  }
};

struct StepPhases {
  PhaseTime dynamics;
  PhaseTime collision;  ///< the whole collision step: `within`, input checks and copies
  CollisionPhases within;
  PhaseTime velocity;  ///< the final velocity
  StepPhases& operator+=(const StepPhases& other) {
    dynamics += other.dynamics;
    collision += other.collision;
    within += other.within;
    velocity += other.velocity;
    return *this;
  }
};

/// Calls visit(name, phase) for every phase of `phases`, in the order in which a step runs.
template <class Phases, class Visit>
void for_each_phase(Phases& phases, Visit visit) {
  visit("dynamics", phases.dynamics);
  visit("proximity", phases.within.proximity);
  visit("repulsion", phases.within.repulsion);
  visit("search", phases.within.search);
  visit("response", phases.within.response);
  visit("collision", phases.collision);
  visit("velocity", phases.velocity);
}

/// Adds the time of its scope.
class PhaseTimer {
 public:
  explicit PhaseTimer(PhaseTime& phase) : phase_(phase) {}
  ~PhaseTimer() {
    phase_.wall_s += std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count();
    phase_.cpu_s += process_cpu_s() - cpu_s_;
  }
  PhaseTimer(const PhaseTimer&) = delete;
  PhaseTimer& operator=(const PhaseTimer&) = delete;

 private:
  static double process_cpu_s() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }

  PhaseTime& phase_;
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
  double cpu_s_ = process_cpu_s();
};

}  // namespace selvage::sim
