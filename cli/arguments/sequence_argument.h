// The sequence that a subcommand reads: the same words and the same options everywhere.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "io/sequence.h"

namespace selvage::cli {

struct SequenceArgument {
  std::vector<std::filesystem::path> sources;
  std::filesystem::path base;  ///< the mesh that a point cache moves; may be empty
};

/// Adds the positional SEQUENCE and --base; `argument` must outlive the parsing.
void add_sequence_argument(CLI::App& command, SequenceArgument& argument);

/// Throws io::Error, and UsageError where --base is given for what has faces of its own. The notes are said on stderr.
[[nodiscard]] std::unique_ptr<io::SequenceReader> open_sequence(const SequenceArgument& argument);

/// What to know of the sequence before trusting what is said of it, a sentence each: a jump in the numbers of its
/// files, what is left out, what was changed.
[[nodiscard]] std::vector<std::string> notes_on(const SequenceArgument& argument, const io::SequenceReader& sequence);

/// Throws UsageError where an output is one of the files that are read or that a run in the folder goes on from, or
/// where two outputs are one file.
void require_outputs_apart_from(const SequenceArgument& argument, const std::vector<std::filesystem::path>& outputs);

}  // namespace selvage::cli
