// What the generators are worth: which class of queries kills which mutant, which one kills it first, and which one
// holds a record of sharpness.
#pragma once

#include <string>
#include <vector>

#include "tests/mutants/mutant_list.h"

namespace selvage::mutants {

struct ClassWorth {
  std::string name;
  std::vector<std::string> kills;  ///< mutants
  /// "MK3 ee": no class kills the mutant in a larger share of its queries of that kind, so none does in fewer cases.
  std::vector<std::string> first;
  /// Mutants that no class kills more often in a work unit of a campaign, which gives cheap classes more cases.
  std::vector<std::string> first_in_campaign;
  std::vector<std::string> alone;    ///< mutants that it alone kills
  std::vector<std::string> records;  ///< "nearest vf" (fuzz/run/records.h), without a mutant

  /// Else the campaign would be as sharp without it.
  [[nodiscard]] bool earns_its_place() const {
    return !first.empty() || !first_in_campaign.empty() || !records.empty();
  }
};

/// Of every class on the mutants whose killer is a property of queries: `cases` cases a class, kind and mutant.
[[nodiscard]] std::vector<ClassWorth> rank_classes(const std::vector<Mutant>& mutants, long cases, int jobs);

}  // namespace selvage::mutants
