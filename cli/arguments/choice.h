// Options whose value is one of a few words. CLI11's transformer takes the numbers behind the words too, and prints
// them as characters where they are bytes.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace selvage::cli {

template <typename Chosen>
struct ChoiceOf {
  using Value = Chosen;
};
template <typename Chosen>
struct ChoiceOf<std::optional<Chosen>> {
  using Value = Chosen;
};

/// Help lists the words as "draft|full"; `value` must outlive the parsing. It may be optional, and stays as it is where
/// nothing is chosen.
template <typename Chosen>
void add_choice(CLI::App& command, const std::string& name, Chosen& value,
                std::vector<std::pair<std::string, typename ChoiceOf<Chosen>::Value>> choices,
                const std::string& help) {
  std::string words;
  for (const auto& choice : choices) words += (words.empty() ? "" : "|") + choice.first;
  const auto choose = [name, words, choices = std::move(choices), &value](const std::string& word) {
    const auto chosen = std::ranges::find_if(choices, [&](const auto& choice) { return choice.first == word; });
    if (chosen == choices.end()) throw CLI::ValidationError(name, fmt::format("'{}' is not {}", word, words));
    value = chosen->second;
  };
  command.add_option_function<std::string>(name, choose, help)->type_name(words);
}

}  // namespace selvage::cli
