// A scene as `selvage sim` runs it, every step checked exactly.
#pragma once

#include <string>

#include "bench/stability/exact_watch.h"
#include "bench/stability/trial.h"
#include "sim/step.h"

namespace selvage::bench {

/// The tables that scenes under gravity start with: drag, steps of 1/60 s, a thickness of 4 mm, friction; `more` stands
/// above the tables.
[[nodiscard]] std::string scene_start(double drag_1_s, double friction, const std::string& more = "");

class ScenePlay {
 public:
  /// `toml` as in docs/scenes.md; everything is moved by the trial's offset, `length_m` being the scene's length.
  /// Requires that the start is free of intersections.
  ScenePlay(Trial& trial, const std::string& toml, double length_m);

  const sim::StepResult& step();
  /// Steps until `time_s`.
  void run_to(double time_s);

  [[nodiscard]] const sim::Simulation& simulation() const { return simulation_; }
  [[nodiscard]] const Positions& x() const { return simulation_.x(); }
  [[nodiscard]] Vec3 offset() const { return offset_; }
  [[nodiscard]] double fastest_m_s() const;  ///< of the cloth's vertices
  /// Of springs that have a strain limit, relative to their length at rest.
  [[nodiscard]] double largest_strain() const;

 private:
  Vec3 offset_;
  sim::Simulation simulation_;
  ExactWatch watch_;
  sim::StepResult last_;
};

}  // namespace selvage::bench
