#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/stability/suite.h"

namespace selvage::bench {
namespace {

/// The trial's figures of one name: the one nearest to its limit, or farthest beyond it.
std::string worst_figures(const StabilityCaseReport& report) {
  std::vector<Figure> worst;
  for (const TrialReport& trial : report.trials) {
    for (const Figure& figure : trial.figures) {
      const auto known = std::ranges::find(worst, figure.name, &Figure::name);
      if (known == worst.end()) {
        worst.push_back(figure);
      } else if (figure.at_most ? !(figure.value <= known->value) : !(figure.value >= known->value)) {
        *known = figure;
      }
    }
  }
  std::string text;
  for (const Figure& figure : worst) {
    text += fmt::format("{}{} {:.2g} ({} {:g})", text.empty() ? "" : "; ", figure.name, figure.value,
                        figure.at_most ? "<=" : ">=", figure.limit);
  }
  return text;
}

template <class Member>
std::int64_t total(const StabilityCaseReport& report, Member member) {
  std::int64_t sum = 0;
  for (const TrialReport& trial : report.trials) sum += trial.*member;
  return sum;
}

std::string describe(const Variant& variant) {
  return fmt::format("resolution {}, {}{}", variant.resolution, variant.far ? "far" : "at the origin",
                     variant.quick ? ", quick" : "");
}

nlohmann::ordered_json json_of(const TrialReport& trial) {
  nlohmann::ordered_json figures = nlohmann::ordered_json::array();
  for (const Figure& figure : trial.figures) {
    figures.push_back(
        {{"name", figure.name}, {"value", figure.value}, {figure.at_most ? "at_most" : "at_least", figure.limit}});
  }
  return {{"resolution", trial.variant.resolution},
          {"far", trial.variant.far},
          {"passed", trial.failure.empty()},
          {"failure", trial.failure},
          {"vertices", trial.vertices},
          {"faces", trial.faces},
          {"steps", trial.steps},
          {"pairs_examined", trial.pairs_examined},
          {"gap_at_least_m", trial.gap_at_least_m},  // null where there was no frame
          {"steps_with_contact", trial.steps_with_contact},
          {"steps_with_collisions", trial.steps_with_collisions},
          {"pairs_below_tolerance", trial.pairs_below_tolerance},
          {"fail_safe_steps", trial.fail_safe_steps},
          {"fail_safe_vertices", trial.fail_safe_vertices},
          {"waiting_bodies", trial.waiting_bodies},
          {"cut_candidates", trial.cut_candidates},
          {"figures", figures},
          {"cpu_s", trial.seconds}};
}

}  // namespace

std::string to_markdown(std::span<const StabilityCaseReport> reports) {
  std::string text =
      "| case | passed | steps | with contact | with collisions | fail-safe steps | gap at least, m | asked, and worst "
      "measured |\n"
      "| --- | --- | --- | --- | --- | --- | --- | --- |\n";
  for (const StabilityCaseReport& report : reports) {
    const auto passed = std::ranges::count_if(report.trials, [](const auto& trial) { return trial.failure.empty(); });
    double gap_m = std::numeric_limits<double>::infinity();
    for (const TrialReport& trial : report.trials) gap_m = std::min(gap_m, trial.gap_at_least_m);
    const std::string figures = worst_figures(report);
    text +=
        fmt::format("| {} | {} of {} | {} | {} | {} | {} | {} | {}{}{} |\n", report.name, passed, report.trials.size(),
                    total(report, &TrialReport::steps), total(report, &TrialReport::steps_with_contact),
                    total(report, &TrialReport::steps_with_collisions), total(report, &TrialReport::fail_safe_steps),
                    std::isfinite(gap_m) ? fmt::format("{:.2g}", gap_m) : "-", report.criterion,
                    figures.empty() ? "" : ": ", figures);
  }
  for (const StabilityCaseReport& report : reports) {
    for (const TrialReport& trial : report.trials) {
      if (trial.failure.empty()) continue;
      text += fmt::format("\nFAILED {}, {}: {}\n", report.name, describe(trial.variant), trial.failure);
    }
  }
  return text;
}

std::string to_json(std::span<const StabilityCaseReport> reports, bool quick) {
  nlohmann::ordered_json cases = nlohmann::ordered_json::array();
  for (const StabilityCaseReport& report : reports) {
    nlohmann::ordered_json trials = nlohmann::ordered_json::array();
    for (const TrialReport& trial : report.trials) trials.push_back(json_of(trial));
    cases.push_back({{"name", report.name},
                     {"difficulty", report.difficulty},
                     {"criterion", report.criterion},
                     {"passed", report.passed()},
                     {"trials", trials}});
  }
  const auto passed = std::ranges::count_if(reports, [](const StabilityCaseReport& report) { return report.passed(); });
  const nlohmann::ordered_json json = {
      {"schema", "selvage.bench.stability/1"}, {"quick", quick}, {"passed", passed}, {"cases", cases}};
  return json.dump(2) + "\n";
}

}  // namespace selvage::bench
