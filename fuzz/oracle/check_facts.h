// What the exact checker found, in lines for people.
#pragma once

#include <string>
#include <vector>

#include "verify/check.h"

namespace selvage::fuzz {

/// So many violations are told; more need not be looked for.
inline constexpr std::size_t kListedFacts = 4;
/// "exactly, WHAT is free of touching", or one line for each of the first violations: which vertices, how, and when.
void append_facts(std::vector<std::string>& facts, const std::string& what, const verify::CheckResult& result);

}  // namespace selvage::fuzz
