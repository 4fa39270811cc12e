// A case that only its seed can make again: one that its first run did not survive. It has no lines but the common
// ones; `seed PROPERTY:STREAM:SEED:NUMBER` says what to draw.
#pragma once

#include "fuzz/kept/kept_case.h"

namespace selvage::fuzz {

inline constexpr std::string_view kDrawn = "drawn";  ///< the kind

[[nodiscard]] std::string drawn_text(const std::string& origin, const std::string& failure);

/// Throws io::Error where `origin` is no case that can be drawn.
[[nodiscard]] std::unique_ptr<KeptCase> parse_drawn_case(const std::string& origin, const Redraw& redraw,
                                                         CaseLines& lines);

}  // namespace selvage::fuzz
