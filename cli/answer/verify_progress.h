// What a long check has done so far, on disk: a run that is killed loses a second of work, or
// ten times what it takes to keep what there is.
#pragma once

#include <chrono>
#include <filesystem>
#include <optional>

#include "verify/report/report.h"

namespace selvage::cli {

class VerifyProgress {
 public:
  /// FILE.progress, beside the report.
  [[nodiscard]] static std::filesystem::path file_of(std::filesystem::path report) { return report += ".progress"; }
  /// Whether the name is one that a file can have: that of `report` may be so long that it is not.
  [[nodiscard]] static bool can_keep(const std::filesystem::path& report);
  /// Throws io::Error where it is not.
  static void require_name(const std::filesystem::path& report);
  /// Keeps there the report on the frames that are done. `context` must outlive it.
  VerifyProgress(std::filesystem::path report, const verify::ReportContext& context);

  /// What a report must be about.
  struct Wanted {
    std::string sequence;  ///< verify::sequence_identity()
    std::int64_t first_frame, end_frame, max_violations;
  };
  /// The report to continue from: progress, or a finished report; nothing where there is neither. Throws UsageError
  /// where it was made by another program or with other options, io::Error where it is about something else.
  [[nodiscard]] std::optional<verify::SequenceReport> load(const Wanted& wanted) const;
  /// Keeps the report, and writes it at most once a second. Where a report is so long that either takes more than a
  /// tenth of the time since, it waits.
  void note(const verify::SequenceReport& report);
  /// Writes what was noted last. Whether anything was noted in this run, and is on disk: where it cannot be written the
  /// check goes on, and a note on stderr says so once.
  [[nodiscard]] bool flush();
  [[nodiscard]] const std::filesystem::path& file() const { return file_; }
  /// The run is complete: there is nothing to continue.
  void remove() const;

 private:
  using Clock = std::chrono::steady_clock;

  std::filesystem::path report_file_, file_;
  const verify::ReportContext& context_;
  std::optional<verify::SequenceReport> unwritten_;
  bool has_noted_ = false, has_failed_ = false;
  Clock::time_point next_copy_, next_write_;
};

}  // namespace selvage::cli
