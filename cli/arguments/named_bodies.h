// What a file cannot say of its groups, and the user can: which of them are bodies.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "io/sequence.h"

namespace selvage::cli {

/// The sequence, with the role of a body for the groups of these names, in every frame that has them; those that the
/// user makes (`own`) are added to it. Throws UsageError where a name is that of neither.
[[nodiscard]] std::unique_ptr<io::SequenceReader> with_bodies(std::unique_ptr<io::SequenceReader> sequence,
                                                              const std::vector<std::string>& names,
                                                              const std::vector<io::Group>& own);

}  // namespace selvage::cli
