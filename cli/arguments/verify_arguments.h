// The command line of `selvage verify`, and what it asks of the checker.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/arguments/sequence_argument.h"
#include "cli/arguments/thread_limit.h"
#include "verify/check.h"

namespace selvage::cli {

struct VerifyArguments {
  SequenceArgument sequence;
  bool frames_only = false, motion = false, bodies = false, weld = false, resume = false, gap = false;
  bool fail_fast = false;
  bool second_opinion = false, second_opinion_all = false;
  std::optional<double> min_distance;
  std::vector<std::string> groups, body, exempt, ignore;
  std::string json, html, shard;
  std::int64_t html_mb = 20;
  std::filesystem::path cases;
  std::optional<std::int64_t> max_violations;
  ThreadLimit threads;
};

void add_verify_arguments(CLI::App& command, VerifyArguments& arguments);

/// Where the user names no number: what a reader of the JSON can page through, and what fits on a terminal.
inline constexpr std::int64_t kViolationsInJson = 100;
inline constexpr std::int64_t kViolationsInText = 10;

/// The sequence of the arguments, with the groups that --body names as bodies. Throws as open_sequence() does, and
/// UsageError where there is no such group.
[[nodiscard]] std::unique_ptr<io::SequenceReader> open_sequence(const VerifyArguments& arguments);

/// Of each --group that has the name of a group of the sequence: that the two are one.
[[nodiscard]] std::vector<std::string> notes_on_groups(const VerifyArguments& arguments,
                                                       const io::SequenceReader& sequence);
/// Throws UsageError where they make no sense for the sequence.
[[nodiscard]] verify::SequenceOptions sequence_options(const VerifyArguments& arguments,
                                                       const io::SequenceReader& sequence);
/// What decides on the verdict, by name and in a fixed order: reports on parts are joined only where it is the same.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> recorded_options(const VerifyArguments& arguments,
                                                                                const verify::SequenceOptions& options);

}  // namespace selvage::cli
