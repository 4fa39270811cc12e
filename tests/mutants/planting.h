// Mutant schemata: one copy of a source holds all its mutants, and a number at run time says which one is on. So no
// mutant needs a build of its own, and the sources that are shipped know nothing of mutants.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/mutants/mutant_list.h"

namespace selvage::mutants {

/// The text of `file` in which every place that a mutant names has become a choice: `good`, or what the mutant says. A
/// place may belong to several mutants. Throws std::runtime_error where a find does not stand there exactly once, or
/// two of them overlap without being the same: then the list is behind the source, and is to be mended.
[[nodiscard]] std::string plant(std::string_view text, const std::string& file, const std::vector<Mutant>& mutants);

}  // namespace selvage::mutants
