// What the generators are worth: which class of queries kills which mutant, and which one kills it fastest.
#pragma once

#include <string>
#include <vector>

#include "tests/mutants/mutant_list.h"

namespace selvage::mutants {

struct ClassWorth {
  std::string name;
  std::vector<std::string> kills;  ///< mutants
  /// Mutants that no class kills in a larger share of its cases, which is to say sooner on average.
  std::vector<std::string> leads;
  std::vector<std::string> alone;  ///< mutants that it alone kills
};

/// Of every class on the mutants whose killer is a property of queries: `cases` cases a class, kind and mutant.
[[nodiscard]] std::vector<ClassWorth> rank_classes(const std::vector<Mutant>& mutants, long cases, int jobs);

}  // namespace selvage::mutants
