// The stability suite: named hard cases, each at three resolutions and two offsets, every step checked exactly.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bench/stability/trial.h"

namespace selvage::bench {

struct StabilityCase {
  std::string name;
  std::string difficulty;  ///< what makes it hard
  /// What is asked besides what is asked of all: every step ends safe and is exactly free of touching, at its end and
  /// in its motion; what is nearer than the tolerance is named in its report; scripts are followed to the bit.
  std::string criterion;
  std::function<void(Trial&)> run;
};

/// All cases, in the order of the table. Names are unique.
[[nodiscard]] std::vector<StabilityCase> stability_cases();

struct StabilityOptions {
  bool quick = false;  ///< the coarse resolution alone, and few steps
  /// Called before each trial with (done, total); returning false ends the run there.
  std::function<bool(std::size_t, std::size_t)> progress = {};
};

struct StabilityCaseReport {
  std::string name, difficulty, criterion;
  std::vector<TrialReport> trials;

  [[nodiscard]] bool passed() const;
};

/// Runs the cases, one trial after another. Whatever a trial throws is its failure. Nothing where the run was ended.
[[nodiscard]] std::optional<std::vector<StabilityCaseReport>> run_stability(std::span<const StabilityCase> cases,
                                                                            const StabilityOptions& options);

/// A Markdown table, one row a case, the worst of its trials; then what failed.
[[nodiscard]] std::string to_markdown(std::span<const StabilityCaseReport> reports);
/// Schema selvage.bench.stability/1.
[[nodiscard]] std::string to_json(std::span<const StabilityCaseReport> reports, bool quick);

}  // namespace selvage::bench
