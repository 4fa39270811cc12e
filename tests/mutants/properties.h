// The properties that kill mutants: what the tests and the campaigns check, each as a search for the first failing
// case.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fuzz/base/choice_source.h"

namespace selvage::mutants {

struct Kill {
  long cases = 0;    ///< until the failure, that one included
  std::string what;  ///< failed, in a word or a few
};

struct Property {
  std::string_view name;
  std::string_view claim;  ///< one line for people
  /// The first failing one of at most `limit` cases, which depend on the seed alone.
  std::optional<Kill> (*falsify)(std::uint64_t seed, long limit);
  bool is_about_threads = false;  ///< else it runs on one
};

[[nodiscard]] std::vector<Property> query_properties();
[[nodiscard]] std::vector<Property> bound_properties();
[[nodiscard]] std::vector<Property> cull_properties();
[[nodiscard]] std::vector<Property> mesh_properties();
[[nodiscard]] std::vector<Property> checker_properties();
[[nodiscard]] std::vector<Property> step_properties();
[[nodiscard]] std::vector<Property> simulation_properties();
/// All that the program links: all_properties.cpp or only_query_properties.cpp.
[[nodiscard]] const std::vector<Property>& properties();
/// Throws std::runtime_error where there is none.
[[nodiscard]] const Property& property_named(std::string_view name);

/// Cases one by one: `check(seed of the case)` names what fails, or is empty.
template <typename Check>
std::optional<Kill> first_failure(std::uint64_t seed, long limit, const Check& check) {
  for (long number = 0; number < limit; ++number) {
    std::string what(check(fuzz::mix(seed, static_cast<std::uint64_t>(number))));
    if (!what.empty()) return Kill{number + 1, std::move(what)};
  }
  return std::nullopt;
}

/// The same as a function, for a table of properties.
template <auto check>
std::optional<Kill> falsify(std::uint64_t seed, long limit) {
  return first_failure(seed, limit, check);
}

}  // namespace selvage::mutants
