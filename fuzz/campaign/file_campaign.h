// The parsers under damaged files: refused or accepted and sound, never anything else.
#pragma once

#include <memory>

#include "fuzz/campaign/property.h"

namespace selvage::fuzz {

/// A stream for each format: a valid file with a few edits.
[[nodiscard]] std::unique_ptr<Property> make_file_campaign();

}  // namespace selvage::fuzz
