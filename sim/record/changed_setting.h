// Two texts of one scene file, compared by what they set.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace selvage::sim {

/// The first setting of `now`, from its top, that has another value in `before` or none, or else the first of `before`
/// that is gone: "time.frames (line 3) was 10 and is 12". Tables of a list are counted from 0: body[1].key[0].time_s.
/// Nothing where they differ in comments and layout alone.
[[nodiscard]] std::optional<std::string> changed_setting(std::string_view before, std::string_view now);

}  // namespace selvage::sim
