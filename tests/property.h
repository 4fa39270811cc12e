// RapidCheck properties as GoogleTest cases with fixed seeds: a test run says the same thing every time.
#pragma once

#include <cstdint>
#include <cstdlib>
#include <sstream>
#include <utility>

#include <gtest/gtest.h>
#include <rapidcheck.h>

namespace selvage::testing {

/// Runs `property` on `cases` cases that depend on the seed alone; the environment variable RC_PARAMS overrides both.
/// A failure prints the shrunk counterexample and the number of cases it took.
template <typename Property>
void check_property(int cases, std::uint64_t seed, Property&& property) {
  rc::detail::TestParams params;
  params.seed = seed;
  params.maxSuccess = cases;
  if (std::getenv("RC_PARAMS") != nullptr) params = rc::detail::configuration().testParams;
  const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
  const rc::detail::TestMetadata metadata{std::string(info->test_suite_name()) + "/" + info->name(), info->name()};
  const auto result = rc::detail::checkTestable(std::forward<Property>(property), metadata, params);
  if (result.template is<rc::detail::SuccessResult>()) return;
  std::ostringstream message;
  rc::detail::printResultMessage(result, message);
  ADD_FAILURE() << message.str();
}

}  // namespace selvage::testing
