// What became of every mutant: as a table in Markdown, and as JSON (schema "selvage.mutants/1").
#pragma once

#include <string>
#include <vector>

#include "tests/mutants/class_ranking.h"
#include "tests/mutants/mutant_runs.h"

namespace selvage::mutants {

struct MutantOutcome {
  Mutant mutant;
  std::vector<TaskResult> runs;  ///< one a seed

  /// Killed under every seed; or proven equivalent, and killed under none.
  [[nodiscard]] bool is_settled() const;
};

struct Report {
  std::vector<MutantOutcome> outcomes;
  std::vector<TaskResult> base;
  std::vector<ClassWorth> classes;  ///< empty where not asked for
};

[[nodiscard]] std::string json_report(const Report& report);
[[nodiscard]] std::string markdown_report(const Report& report);

}  // namespace selvage::mutants
