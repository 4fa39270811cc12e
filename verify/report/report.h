// A sequence report for people (text) and for programs (JSON, schema "selvage.verify/1").
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "verify/check.h"

namespace selvage::verify {

inline constexpr const char* kReportSchema = "selvage.verify/1";

[[nodiscard]] const char* name_of(Verdict verdict);  ///< clean, violated, unknown
[[nodiscard]] const char* name_of(EventKind event);  ///< vf, ee, overlap, self

/// What the report is about, in the words of the user.
struct ReportContext {
  std::string program;                              ///< name and version
  std::vector<std::string> sources;                 ///< as given
  std::map<std::int64_t, std::string> frame_names;  ///< by number
  /// What was asked for, by name: reports with other options are not about the same thing.
  std::vector<std::pair<std::string, std::string>> options = {};
  std::vector<std::string> notes = {};  ///< what to know of the sequence before trusting the verdict, a sentence each
  bool is_rounded = false;  ///< what is checked was rounded: vertices at one place are then no sign of a seam
};

/// Several lines, the verdict first, the violations last: at most `max_listed`, and how many more there are.
[[nodiscard]] std::string text_report(const SequenceReport& report, const ReportContext& context,
                                      std::size_t max_listed);
/// One JSON object; docs/formats.md describes its keys.
[[nodiscard]] std::string json_report(const SequenceReport& report, const ReportContext& context);

/// What explains the case, as one types it into a shell.
[[nodiscard]] std::string replay_command(const std::string& case_file);
/// The first frame whose surface is not that of the frame before.
[[nodiscard]] std::optional<std::int64_t> first_surface_change(const SequenceReport& report);

struct ParsedReport {
  SequenceReport report;
  ReportContext context;  ///< frame_names: only those that violations name
};
/// The inverse of json_report(). Throws io::Error naming `name` where the text is no such report.
[[nodiscard]] ParsedReport parse_report(const std::string& json, const std::string& name);

}  // namespace selvage::verify
