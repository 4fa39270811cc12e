// How a body moves between two times, and what a step makes of it.
#pragma once

#include <Eigen/Geometry>

#include "kernel/types.h"

namespace selvage::sim {

/// Of places of its vertices, as many rows each. A step of the simulation takes them on straight lines, and the
/// dynamics within it at
///   from + s (to - from) - s (1 - s) bow,   s from 0 to 1,
/// a parabola through where they are halfway. That is how what turns or speeds up evenly moves. What starts, stops or
/// turns back within the step is not like it at all: a plate that starts halfway would be three times as fast at its
/// end as it was on average, where it is twice, and threw cloth at 8.5 m/s for 6. So a body has no bow then, and is
/// seen to go evenly.
class Passage {
 public:
  Passage(Positions from, const Positions& middle, const Positions& to);

  /// Where they are at `share` of the time, in (0, 1). What follows is of all that it has been told; a quarter and
  /// three quarters are the least that tells a bow from a start.
  void add(double share, const Positions& at);

  /// #rows by 3, m. Zero where the parabola is off by more than an eighth of its height anywhere.
  [[nodiscard]] Positions bow_m() const;
  /// How far they are from where the dynamics has them.
  [[nodiscard]] double off_by_m() const;
  /// How far they leave the straight lines.
  [[nodiscard]] double leaves_line_by_m() const;
  [[nodiscard]] const Eigen::AlignedBox3d& box() const { return box_; }

 private:
  [[nodiscard]] bool is_bow() const;
  [[nodiscard]] double unless_rounding(double length_m) const { return length_m > rounding_m_ ? length_m : 0; }

  Positions from_, way_, bow_;
  double rounding_m_;  ///< of places, however far out; thousands of times more than there is
  double bow_is_off_by_m_ = 0, line_is_off_by_m_ = 0, leaves_line_by_m_ = 0;
  Eigen::AlignedBox3d box_;
};

}  // namespace selvage::sim
