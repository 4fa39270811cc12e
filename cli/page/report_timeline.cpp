#include "cli/page/report_timeline.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "cli/page/report_words.h"

namespace selvage::cli {

using page::element;
using page::Html;
using page::text;

namespace {

constexpr std::int64_t kMaxBars = 200;  // 4 pixels each in a window of 1,000

struct Bar {
  std::int64_t begin = 0, end = 0;  ///< frames
  std::int64_t violations = 0;
  std::int64_t shown = 0;  ///< the frame to go to: the first that is violated
  bool is_checked = true;
  std::string what;
};

void add_words(std::string& what, const verify::SequenceReport::Violated& unit) {
  std::string events;
  const auto add = [&](std::int64_t count, const char* name) {
    if (count > 0) events += fmt::format("{}{} {}", events.empty() ? "" : ", ", grouped(count), name);
  };
  add(unit.counts.vf, "vertex-face");
  add(unit.counts.ee, "edge-edge");
  add(unit.counts.overlap, "face-face");
  add(unit.counts.self, "within a face");
  what += fmt::format("{}{}: {}", what.empty() ? "" : "; ", unit_of(unit.frame, unit.motion), events);
}

std::vector<Bar> bars_of(const verify::SequenceReport& report) {
  const std::int64_t count = report.end_frame - report.first_frame, bar_count = std::min(count, kMaxBars);
  const std::int64_t checked_end = report.first_frame + std::ssize(report.frame_crc32);
  std::vector<Bar> bars;
  for (std::int64_t i = 0; i < bar_count; ++i) {
    Bar bar;
    bar.begin = bar.shown = report.first_frame + i * count / bar_count;
    bar.end = report.first_frame + (i + 1) * count / bar_count;
    bar.is_checked = bar.end <= checked_end;
    bars.push_back(bar);
  }
  for (const verify::SequenceReport::Violated& unit : report.violated) {
    // A part's first motion starts at the frame before it.
    const std::int64_t frame = std::max(unit.frame, report.first_frame);
    Bar& bar = *std::find_if(bars.begin(), bars.end(), [&](const Bar& b) { return frame < b.end; });
    if (bar.violations == 0) bar.shown = unit.frame;
    bar.violations += unit.counts.total();
    add_words(bar.what, unit);
  }
  return bars;
}

Html button_of(const Bar& bar, std::int64_t most) {
  const std::string frames = bar.end - bar.begin == 1 ? fmt::format("Frame {}", bar.begin)
                                                      : fmt::format("Frames {} to {}", bar.begin, bar.end - 1);
  std::string state = "clean", title = bar.what.empty() ? frames + ": no violation" : bar.what;
  double height = 0.12;  // so that a frame without violations can be seen and hit
  if (bar.violations > 0) {
    state = "violated";
    height = 0.3 + 0.7 * std::log1p(static_cast<double>(bar.violations)) / std::log1p(static_cast<double>(most));
  } else if (!bar.is_checked) {
    state = "unknown";
    title = frames + ": not checked";
    height = 0.3;
  }
  return element("button",
                 {{"type", "button"},
                  {"class", state},
                  {"title", title},
                  {"aria-label", title},
                  {"data-begin", std::to_string(bar.begin)},
                  {"data-end", std::to_string(bar.end)},
                  {"data-frame", std::to_string(bar.shown)}},
                 element("i", {{"style", fmt::format("--height: {:.0f}%", 100 * height)}}, {}));
}

}  // namespace

Html report_timeline(const verify::SequenceReport& report) {
  const std::vector<Bar> bars = bars_of(report);
  std::int64_t most = 1;
  for (const Bar& bar : bars) most = std::max(most, bar.violations);
  Html items;
  for (const Bar& bar : bars) items += element("li", {}, button_of(bar, most)) + Html{"\n"};
  return element("ol", {{"id", "timeline"}}, items) +
         element("p", {{"id", "timeline-status"}, {"class", "quiet"}, {"role", "status"}}, {});
}

}  // namespace selvage::cli
