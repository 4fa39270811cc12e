// Options that take a list. CLI11 gives a list all the words that follow, and so the files of the command.
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace selvage::cli {

/// One word a use, of values between commas; may be repeated.
inline CLI::Option* as_list(CLI::Option* option) { return option->delimiter(',')->allow_extra_args(false); }

/// `values` must outlive the parsing.
template <typename Value>
CLI::Option* add_list(CLI::App& command, const std::string& name, std::vector<Value>& values, const std::string& help) {
  return as_list(command.add_option(name, values, help + "; several between commas"));
}

}  // namespace selvage::cli
