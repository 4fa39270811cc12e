// What a report says, in the words of its page.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "page/html.h"
#include "verify/report/report.h"

namespace selvage::cli {

/// "12,345,678".
[[nodiscard]] std::string grouped(std::int64_t count);
/// "1 frame", "2 frames".
[[nodiscard]] std::string counted(std::int64_t count, const std::string& singular);

/// The files; the first and the last where there are many.
[[nodiscard]] std::string source_names(const std::vector<std::string>& sources);

[[nodiscard]] std::string verdict_sentence(const verify::SequenceReport& report);
/// The counts of work and of what was found.
[[nodiscard]] page::Html facts(const verify::SequenceReport& report);
/// What the check leaves out, and the notes on the sequence, one paragraph each; empty where nothing is.
[[nodiscard]] page::Html left_out(const verify::SequenceReport& report, const std::vector<std::string>& notes);

/// "vertex 3 and face 7"; "motion 12 to 13" or "frame 12"; "crosses".
[[nodiscard]] std::string features_of(const verify::Violation& violation);
[[nodiscard]] std::string unit_of(std::int64_t frame, bool motion);

}  // namespace selvage::cli
