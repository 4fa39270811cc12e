// Options whose value is one of a few words, or a list of such. CLI11's transformer takes the numbers behind the words
// too, and prints them as characters where they are bytes.
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "cli/arguments/list_option.h"

namespace selvage::cli {

template <typename Chosen>
struct ChoiceOf {
  using Value = Chosen;
};
template <typename Chosen>
struct ChoiceOf<std::optional<Chosen>> {
  using Value = Chosen;
};

/// Words and what they mean.
template <typename Value>
using Choices = std::vector<std::pair<std::string, Value>>;

/// As help and mistakes list them: "draft|full".
template <typename Value>
std::string words_of(const Choices<Value>& choices) {
  std::string words;
  for (const auto& choice : choices) words += (words.empty() ? "" : "|") + choice.first;
  return words;
}

/// What `word` means; CLI::ValidationError for one that is not among them.
template <typename Value>
Value meaning_of(const std::string& word, const std::string& option, const Choices<Value>& choices) {
  const auto chosen = std::ranges::find_if(choices, [&](const auto& choice) { return choice.first == word; });
  if (chosen == choices.end()) {
    throw CLI::ValidationError(option, fmt::format("'{}' is not {}", word, words_of(choices)));
  }
  return chosen->second;
}

/// `value` must outlive the parsing. It may be optional, and stays as it is where nothing is chosen.
template <typename Chosen>
void add_choice(CLI::App& command, const std::string& name, Chosen& value,
                const Choices<typename ChoiceOf<Chosen>::Value>& choices, const std::string& help) {
  const auto choose = [name, choices, &value](const std::string& word) { value = meaning_of(word, name, choices); };
  command.add_option_function<std::string>(name, choose, help)->type_name(words_of(choices));
}

/// The same for a list.
template <typename Value>
void add_choices(CLI::App& command, const std::string& name, std::vector<Value>& values,
                 const Choices<std::type_identity_t<Value>>& choices, const std::string& help) {
  const auto choose = [name, choices, &values](const std::vector<std::string>& words) {
    values.clear();
    for (const std::string& word : words) values.push_back(meaning_of(word, name, choices));
  };
  as_list(command.add_option_function<std::vector<std::string>>(name, choose, help))->type_name(words_of(choices));
}

}  // namespace selvage::cli
