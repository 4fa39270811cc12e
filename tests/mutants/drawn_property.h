// RapidCheck properties as killers.
#pragma once

#include <rapidcheck.h>

#include "tests/mutants/properties.h"

namespace selvage::mutants {

/// Not shrunk: the first failing case counts.
template <typename Check>
std::optional<Kill> first_drawn_failure(std::uint64_t seed, long limit, const Check& check) {
  rc::detail::TestParams params;
  params.seed = seed;
  params.maxSuccess = static_cast<int>(limit);
  params.disableShrinking = true;
  const auto result = rc::detail::checkTestable(check, rc::detail::TestMetadata{}, params);
  rc::detail::FailureResult failure;
  if (!result.match(failure)) return std::nullopt;
  const std::string text = failure.description.substr(failure.description.find("RC_"));
  return Kill{failure.numSuccess + 1, text.substr(0, text.find('\n'))};
}

}  // namespace selvage::mutants
