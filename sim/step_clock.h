// The adaptive collision step (paper, section 5): halved when repulsions did not prevent collisions, doubled after
// three good steps, as StepAllowance judges both; never across the border of a frame. Where a doubled step fails within
// a few steps, twice as many are asked for the next doubling: cloth that hangs over an edge rests at one step and not
// at twice that, and was kicked after every third one.
#pragma once

#include <cstdint>

namespace selvage::sim {

/// Time is counted in ticks of frame / 2^n, so that it does not drift and every frame is met exactly.
class StepClock {
 public:
  /// Steps are frames divided by powers of two, between shortest_s and longest_s; if no such step lies between them,
  /// the largest one below longest_s. Starts with the longest (section 5). REQUIRES 0 < shortest_s <= longest_s and
  /// shortest_s at least kLeastStepShare of a frame.
  StepClock(double frames_per_s, double shortest_s, double longest_s);

  /// Everything that changes; the rest follows from the constructor's arguments.
  struct State {
    std::int64_t frame = 0;  ///< whole frames done
    std::int64_t tick = 0;   ///< ticks done of the next frame
    std::int32_t level = 0;  ///< the step is frame / 2^level
    std::int32_t good_steps = 0;
    std::int32_t good_steps_asked = 0;  ///< in a row, for the next doubling
    std::int32_t on_trial = 0;          ///< steps that must still follow the last doubling to prove it right
    friend bool operator==(const State&, const State&) = default;
  };
  [[nodiscard]] const State& state() const { return state_; }
  void restore(const State& state) { state_ = state; }

  [[nodiscard]] double time_s() const { return time_at(state_.tick); }
  [[nodiscard]] double end_s() const { return time_at(state_.tick + step_ticks()); }
  [[nodiscard]] double dt_s() const;
  /// The longest step is dt_s() times two to this.
  [[nodiscard]] std::int32_t halvings() const { return state_.level - min_level_; }
  /// Whole frames done.
  [[nodiscard]] std::int64_t frame() const { return state_.frame; }
  [[nodiscard]] bool at_frame() const { return state_.tick == 0; }
  /// Whether half the step is no shorter than `shortest_s`, and than the constructor's.
  [[nodiscard]] bool can_halve(double shortest_s = 0) const;

  void halve();
  /// The step is halved before it is tried, which says nothing of how long steps may be later.
  void shorten();
  /// The step is done. `good`: as StepAllowance judges it; in the paper, no collision was left after the repulsions.
  void advance(bool good);

 private:
  [[nodiscard]] std::int64_t step_ticks() const { return std::int64_t{1} << (max_level_ - state_.level); }
  [[nodiscard]] std::int64_t frame_ticks() const { return std::int64_t{1} << max_level_; }
  [[nodiscard]] double time_at(std::int64_t tick) const;

  double frames_per_s_;
  std::int32_t min_level_ = 0, max_level_ = 0;
  State state_;
};

}  // namespace selvage::sim
