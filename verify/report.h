// A sequence report for people (text) and for programs (JSON, schema "selvage.verify/1").
#pragma once

#include <string>
#include <vector>

#include "verify/check.h"

namespace selvage::verify {

inline constexpr const char* kReportSchema = "selvage.verify/1";

[[nodiscard]] const char* name_of(Verdict verdict);  ///< clean, violated, unknown
[[nodiscard]] const char* name_of(EventKind event);  ///< vf, ee, overlap, self

/// What the report is about, in the words of the user.
struct ReportContext {
  std::string program;                   ///< name and version
  std::vector<std::string> sources;      ///< as given
  std::vector<std::string> frame_names;  ///< of all frames
};

/// Several lines, the verdict first, the violations last: at most `max_listed`, and how many more there are.
[[nodiscard]] std::string text_report(const SequenceReport& report, const ReportContext& context,
                                      std::size_t max_listed);
/// One JSON object; docs/formats.md describes its keys.
[[nodiscard]] std::string json_report(const SequenceReport& report, const ReportContext& context);

}  // namespace selvage::verify
