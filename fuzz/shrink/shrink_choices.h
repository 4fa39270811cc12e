// Shrinking by choices: whatever a generator makes, it makes something simpler from fewer and smaller answers.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fuzz/base/choice_source.h"

namespace selvage::fuzz {

using Choices = std::vector<std::uint32_t>;

/// The answers that `source` gives to `failure_of`, made fewer and smaller as long as failure_of() names the same
/// failure: cut off, cut out, zeroed, lowered, until nothing more is accepted or after `max_trials` calls.
/// Deterministic. Where the first call does not fail so, the answers are those of that call.
[[nodiscard]] Choices shrink_choices(const ChoiceSource& source, const std::string& failure,
                                     const std::function<std::string(ChoiceSource)>& failure_of,
                                     std::int64_t max_trials);

}  // namespace selvage::fuzz
