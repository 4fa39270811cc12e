#include "sim/step_clock.h"

#include <algorithm>
#include <cmath>

#include "kernel/assert.h"

namespace selvage::sim {
namespace {

constexpr std::int32_t kFewestGoodSteps = 3;  // section 5: "three successful time steps in a row"
constexpr std::int32_t kMaxGoodSteps = 3072;  // 10 failures in a row: no more than a try in 3,000 steps is lost
constexpr std::int32_t kTrial = 4;  // steps that a doubled step must last: what kicks cloth at rest fails in one or two
constexpr std::int32_t kLevelLimit = 20;  // 2^-20 of a frame is below a millionth

// A step given in decimals, like 0.0166667, must count as the half of 1/30 s that was meant.
constexpr double kSlack = 1 + 1e-3;

}  // namespace

StepClock::StepClock(double frames_per_s, double shortest_s, double longest_s) : frames_per_s_(frames_per_s) {
  SELVAGE_ASSERT(frames_per_s > 0 && shortest_s > 0 && shortest_s <= longest_s);
  const double frame_s = 1 / frames_per_s;
  while (min_level_ < kLevelLimit && std::ldexp(frame_s, -min_level_) > longest_s * kSlack) ++min_level_;
  max_level_ = min_level_;
  while (max_level_ < kLevelLimit && std::ldexp(frame_s, -max_level_ - 1) * kSlack >= shortest_s) ++max_level_;
  state_.level = min_level_;
  state_.good_steps_asked = kFewestGoodSteps;
}

bool StepClock::can_halve(double shortest_s) const {
  return state_.level < max_level_ && dt_s() / 2 * kSlack >= shortest_s;
}

double StepClock::dt_s() const { return std::ldexp(1 / frames_per_s_, -state_.level); }

double StepClock::time_at(std::int64_t tick) const {
  return (double(state_.frame) + std::ldexp(double(tick), -max_level_)) / frames_per_s_;
}

void StepClock::halve() {
  shorten();
  if (state_.on_trial == 0) return;
  state_.on_trial = 0;
  state_.good_steps_asked = std::min(2 * state_.good_steps_asked, kMaxGoodSteps);
}

void StepClock::shorten() {
  SELVAGE_ASSERT(can_halve());
  ++state_.level;
  state_.good_steps = 0;
}

void StepClock::advance(bool good) {
  state_.tick += step_ticks();
  if (state_.tick == frame_ticks()) {
    ++state_.frame;
    state_.tick = 0;
  }
  if (state_.on_trial > 0 && --state_.on_trial == 0) state_.good_steps_asked = kFewestGoodSteps;
  state_.good_steps = good ? state_.good_steps + 1 : 0;
  const bool aligned = state_.tick % (2 * step_ticks()) == 0;
  if (state_.good_steps >= state_.good_steps_asked && state_.level > min_level_ && aligned) {
    --state_.level;
    state_.good_steps = 0;
    state_.on_trial = kTrial;
  }
}

}  // namespace selvage::sim
