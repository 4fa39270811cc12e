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

/// Help lists the words as "draft|full"; what `set` refers to must outlive the parsing.
template <typename Value, typename Set>
void add_choice_of(CLI::App& command, const std::string& name, std::vector<std::pair<std::string, Value>> choices,
                   const std::string& help, const Set& set) {
  std::string words;
  for (const auto& choice : choices) words += (words.empty() ? "" : "|") + choice.first;
  const auto choose = [name, words, choices = std::move(choices), set](const std::string& word) {
    const auto chosen = std::ranges::find(choices, word, &std::pair<std::string, Value>::first);
    if (chosen == choices.end()) throw CLI::ValidationError(name, fmt::format("'{}' is not {}", word, words));
    set(chosen->second);
  };
  command.add_option_function<std::string>(name, choose, help)->type_name(words);
}

template <typename Value>
void add_choice(CLI::App& command, const std::string& name, Value& value,
                std::vector<std::pair<std::string, Value>> choices, const std::string& help) {
  add_choice_of(command, name, std::move(choices), help, [&value](const Value& chosen) { value = chosen; });
}

/// Where nothing is chosen there is none.
template <typename Value>
void add_optional_choice(CLI::App& command, const std::string& name, std::optional<Value>& value,
                         std::vector<std::pair<std::string, Value>> choices, const std::string& help) {
  add_choice_of(command, name, std::move(choices), help, [&value](const Value& chosen) { value = chosen; });
}

}  // namespace selvage::cli
