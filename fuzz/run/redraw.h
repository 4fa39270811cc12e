// Cases that are known by their seed alone (kept/drawn_case.h) are drawn and run again.
#pragma once

#include <optional>

#include "fuzz/kept/kept_case.h"

namespace selvage::fuzz {

/// A case of all_properties(), to be run in a process of its own. Nothing where none of them, or no stream of it, is so
/// called.
[[nodiscard]] std::optional<Redrawn> redraw(const CaseOrigin& origin);

}  // namespace selvage::fuzz
