#include "cli/page/report_scene.h"

#include <algorithm>

#include "cli/page/sequence_scene.h"

namespace selvage::cli {
namespace {

/// Frames without a witness, for a look at the whole: what a person still goes through one by one.
constexpr std::int64_t kFramesInPassing = 24;
/// Of the cloth's radius: 2^-20 is 1 micrometre on a curtain of 2 metres, a thousandth of the cloth's usual thickness.
constexpr int kReportBits = 20;

page::Box witness_box(const verify::SequenceReport& report) {
  page::Box box;
  for (const verify::Violation& violation : report.violations) {
    for (const verify::Point& point : violation.x_t0) box.add(point);
    for (const verify::Point& point : violation.x_t1) box.add(point);
  }
  return box;
}

}  // namespace

std::vector<std::size_t> wanted_frames(const verify::SequenceReport& report) {
  std::vector<std::size_t> frames;
  std::vector<std::uint8_t> is_there(static_cast<std::size_t>(report.frame_count), 0);
  const auto add = [&](std::int64_t frame) {
    std::uint8_t& there = is_there.at(static_cast<std::size_t>(frame));
    if (there == 0) frames.push_back(static_cast<std::size_t>(frame));
    there = 1;
  };
  for (const verify::Violation& violation : report.violations) {
    add(violation.frame);
    if (violation.motion) add(violation.frame + 1);
  }
  const std::int64_t count = report.end_frame - report.first_frame, shown = std::min(count, kFramesInPassing);
  for (std::int64_t i = 0; i < shown; ++i) {
    add(report.first_frame + (shown > 1 ? i * (count - 1) / (shown - 1) : 0));
  }
  return frames;
}

ReportScene report_scene(const verify::SequenceReport& report, const io::SequenceReader* sequence,
                         std::size_t byte_limit) {
  if (sequence == nullptr) return {page::Scene(witness_box(report), kReportBits, page::Prediction::kNone), 0};
  const std::vector<std::size_t> frames = wanted_frames(report);
  ReportScene result{page::Scene(stage_of(*sequence, frames), kReportBits, page::Prediction::kNone), frames.size()};
  const bool has_times = io::has_times(*sequence);
  for (const std::size_t frame : frames) {
    if (!add_frame(result.scene, *sequence, has_times, frame, byte_limit)) break;
  }
  return result;
}

}  // namespace selvage::cli
