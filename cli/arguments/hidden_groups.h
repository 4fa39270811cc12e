// What stands before that which is to be seen, left out of a picture.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "io/sequence.h"

namespace selvage::cli {

/// Adds --hide; `names` must outlive the parsing.
void add_hide(CLI::App& command, std::vector<std::string>& names);

/// The sequence without the faces of the groups of these names, in every frame that has them, nor the vertices of no
/// other face. Throws UsageError where the first frame has no group of a name, or where they hold all its faces.
[[nodiscard]] std::unique_ptr<io::SequenceReader> without_groups(std::unique_ptr<io::SequenceReader> sequence,
                                                                 const std::vector<std::string>& names);

}  // namespace selvage::cli
