#include "cli/answer/verify_progress.h"

#include <algorithm>
#include <cerrno>
#include <climits>
#include <utility>

#include <fmt/format.h>

#include "cli/answer/verdict.h"
#include "cli/process/exit_code.h"
#include "cli/process/terminal.h"
#include "io/fail.h"
#include "io/file/atomic_file.h"

namespace selvage::cli {
namespace {

constexpr std::chrono::seconds kInterval{1};

/// For what began at `start` and ends now, done no more than a tenth of the time. Written every second, a report of
/// 1.9 GB took a check of half a second two minutes.
std::chrono::steady_clock::time_point paced(std::chrono::steady_clock::time_point start) {
  const auto now = std::chrono::steady_clock::now();
  return now + 10 * (now - start);
}

void require_same(const verify::SequenceReport& report, const VerifyProgress::Wanted& wanted, const std::string& file) {
  if (report.max_violations != wanted.max_violations) {
    throw UsageError(
        fmt::format("{}: lists {} violations at most (--max-violations), not {}; resume it with that, or "
                    "remove it to start anew",
                    file, report.max_violations, wanted.max_violations));
  }
  if (report.sequence != wanted.sequence) {
    throw io::Error(io::ErrorKind::kBadInput, file + ": is of another sequence; name that, or remove it to start anew");
  }
  if (report.first_frame == wanted.first_frame && report.end_frame == wanted.end_frame) return;
  throw UsageError(
      fmt::format("{}: is about frames {} to {}, not {} to {}; resume it with the same --shard, or remove "
                  "it to start anew",
                  file, report.first_frame, report.end_frame - 1, wanted.first_frame, wanted.end_frame - 1));
}

}  // namespace

bool VerifyProgress::can_keep(const std::filesystem::path& report) {
  return io::is_nameable(file_of(report).filename());
}

void VerifyProgress::require_name(const std::filesystem::path& report) {
  if (can_keep(report)) return;
  const std::size_t added = file_of("").native().size();
  io::file_error(file_of(report).string(), "keep progress there", ENAMETOOLONG,
                 fmt::format("shorten the name of the report, beside which it is kept, to {} bytes", NAME_MAX - added));
}

VerifyProgress::VerifyProgress(std::filesystem::path report, const verify::ReportContext& context)
    : report_file_(std::move(report)),
      file_(file_of(report_file_)),
      context_(context),
      next_write_(Clock::now() + kInterval) {}

std::optional<verify::SequenceReport> VerifyProgress::load(const Wanted& wanted) const {
  for (const std::filesystem::path& file : {file_, report_file_}) {
    std::error_code absent;  // also of a name that is too long for any file
    if (!std::filesystem::is_regular_file(file, absent)) continue;
    verify::ParsedReport parsed = verify::parse_report(io::read_file(file), file.string());
    if (parsed.context.program != context_.program || parsed.context.options != context_.options) {
      throw UsageError(file.string() + ": made by another version or with other options; remove it to start anew");
    }
    require_same(parsed.report, wanted, file.string());
    // A report that was cut short counts work on half a frame: only progress can be continued.
    if (file == file_ || is_complete(parsed.report)) return std::move(parsed.report);
  }
  return std::nullopt;
}

void VerifyProgress::note(const verify::SequenceReport& report) {
  const Clock::time_point start = Clock::now();
  if (start < next_copy_) return;
  unwritten_ = report;
  has_noted_ = true;
  next_copy_ = paced(start);
  if (start >= next_write_) (void)flush();
}

bool VerifyProgress::flush() {
  if (!unwritten_) return has_noted_;
  const Clock::time_point start = Clock::now();
  next_write_ = start + kInterval;
  try {
    io::write_atomically(file_, verify::json_report(*unwritten_, context_));
    next_write_ = std::max(next_write_, paced(start));
  } catch (const io::Error& error) {
    if (!std::exchange(has_failed_, true)) {
      print_notes(
          {std::string(error.what()) + " (the check goes on; if it is stopped, it cannot be resumed from here)"});
    }
    return false;
  }
  unwritten_.reset();
  return true;
}

void VerifyProgress::remove() const {
  std::error_code absent;
  std::filesystem::remove(file_, absent);
}

}  // namespace selvage::cli
