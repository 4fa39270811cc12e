#include "bench/stability/suite.h"

#include <algorithm>
#include <ctime>
#include <exception>
#include <utility>

#include "bench/stability/cases.h"

namespace selvage::bench {
namespace {

TrialReport run_trial(const StabilityCase& stability_case, const Variant& variant) {
  Trial trial(variant);
  const std::clock_t start = std::clock();
  try {
    stability_case.run(trial);
    // A case that examined nothing has not passed (V3).
    trial.require(!trial.report().figures.empty() || trial.report().steps > 0, "the case looked at nothing");
  } catch (const std::exception& error) {
    trial.report().failure = error.what();
  }
  trial.report().seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  return std::move(trial.report());
}

}  // namespace

std::vector<StabilityCase> stability_cases() {
  std::vector<StabilityCase> all;
  for (const auto& theme :
       {spike_cases(), needle_cases(), degenerate_cases(), layer_cases(), squeeze_cases(), fold_cases(), tie_cases(),
        scale_cases(), rest_cases(), twist_cases(), long_cases(), input_cases()}) {
    all.insert(all.end(), theme.begin(), theme.end());
  }
  return all;
}

bool StabilityCaseReport::passed() const {
  return !trials.empty() && std::ranges::all_of(trials, [](const TrialReport& trial) { return trial.failure.empty(); });
}

std::optional<std::vector<StabilityCaseReport>> run_stability(std::span<const StabilityCase> cases,
                                                              const StabilityOptions& options) {
  std::vector<Variant> variants;
  for (int resolution = 0; resolution < (options.quick ? 1 : 3); ++resolution) {
    for (const bool far : {false, true}) variants.push_back({resolution, far, options.quick});
  }
  std::vector<StabilityCaseReport> reports;
  for (const StabilityCase& stability_case : cases) {
    reports.push_back({stability_case.name, stability_case.difficulty, stability_case.criterion, {}});
    for (const Variant& variant : variants) {
      const std::size_t done = (reports.size() - 1) * variants.size() + reports.back().trials.size();
      if (options.progress && !options.progress(done, cases.size() * variants.size())) return std::nullopt;
      reports.back().trials.push_back(run_trial(stability_case, variant));
    }
  }
  return reports;
}

}  // namespace selvage::bench
