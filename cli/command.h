// What every subcommand shares: help that starts with an example, and a job that runs after parsing.
// A subcommand is one file, NAME_command.cpp, and one line in main.cpp.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "cli/process/exit_code.h"

namespace selvage::cli {

/// The help of `app` starts with "Example: `example`".
void show_example_first(CLI::App& app, const std::string& example);

/// Adds the subcommand `name`. Its file then adds options and sets the callback to `job = [options] { ... }`.
CLI::App& add_command(CLI::App& program, const std::string& name, const std::string& description,
                      const std::string& example);

/// After all its subcommands were added: without one of them, or with an unknown one, the job is an error that names it
/// and lists them.
void require_one_subcommand(CLI::App& command, Job& job);

}  // namespace selvage::cli
