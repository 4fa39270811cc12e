#include "cli/page/player_page.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "cli/page/report_words.h"
#include "cli/page/sequence_scene.h"
#include "page/assets.h"

namespace selvage::cli {

using page::element;
using page::Html;
using page::text;

namespace {

/// Of the cloth's radius: 2^-16 is 15 micrometres on a curtain of 2 metres, a hundredth of what a pixel shows of it.
constexpr int kPlayerBits = 16;

struct Packed {
  page::Scene scene;
  std::size_t frames_tried = 0;  ///< until the limit was reached; all if it was not
  bool is_complete = false;
};

/// Every n-th of `count`, and the last.
std::vector<std::size_t> every(std::size_t stride, std::size_t count) {
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i + 1 < count; i += stride) frames.push_back(i);
  frames.push_back(count - 1);
  return frames;
}

Packed pack(const io::SequenceReader& sequence, const page::Box& stage, const std::vector<std::size_t>& frames,
            std::size_t byte_limit, const std::function<void(std::size_t, std::size_t)>& progress) {
  Packed packed{page::Scene(stage, kPlayerBits, page::Prediction::kPrevious)};
  const bool has_times = io::has_times(sequence);
  for (const std::size_t i : frames) {
    ++packed.frames_tried;
    if (!add_frame(packed.scene, sequence, has_times, i, byte_limit)) return packed;
    progress(i + 1, sequence.frame_count());
  }
  packed.is_complete = true;
  return packed;
}

/// From how far the last attempt came; always larger than `stride`.
std::size_t next_stride(std::size_t stride, std::size_t frames_wanted, std::size_t frames_tried) {
  const double excess =
      static_cast<double>(frames_wanted) / static_cast<double>(std::max<std::size_t>(1, frames_tried - 1));
  return std::max(stride + 1, static_cast<std::size_t>(std::floor(static_cast<double>(stride) * excess)));
}

}  // namespace

PlayerPage player_page(const std::string& title, const io::SequenceReader& sequence, page::UpAxis up,
                       std::size_t byte_limit, const std::function<void(std::size_t, std::size_t)>& progress) {
  const std::size_t count = sequence.frame_count();
  if (count == 0) throw io::Error(io::ErrorKind::kBadInput, "the sequence has no frames; nothing to show");
  // Of the first and the last frame and some between: the view starts so, and what leaves it is drawn all the same.
  const std::set<std::size_t> samples = {0, count / 4, count / 2, count * 3 / 4, count - 1};
  const page::Box stage = stage_of(sequence, {samples.begin(), samples.end()});
  if (stage.is_empty()) throw io::Error(io::ErrorKind::kBadInput, sequence.frame_name(0) + ": no faces to show");
  std::size_t stride = 1;
  std::vector<std::size_t> frames = every(stride, count);
  Packed packed = pack(sequence, stage, frames, byte_limit, progress);
  while (!packed.is_complete && frames.size() > 2) {
    stride = next_stride(stride, frames.size(), packed.frames_tried);
    frames = every(stride, count);
    packed = pack(sequence, stage, frames, byte_limit, progress);
  }
  if (!packed.is_complete) {
    throw io::Error(
        io::ErrorKind::kBadInput,
        fmt::format("{}: {} not fit into --max-mb {}; allow more", sequence.frame_name(0),
                    count == 1 ? "the frame does" : "the first and the last frame do", byte_limit / 1000000));
  }
  const page::Scene& scene = packed.scene;
  PlayerPage made;
  made.summary = fmt::format("{} of {} ({}), rounded to multiples of {:.3g} for display, {:.1f} MB of meshes",
                             grouped(static_cast<std::int64_t>(scene.frame_count())),
                             counted(static_cast<std::int64_t>(count), "frame"),
                             stride == 1 ? "all" : fmt::format("one in {} and the last", stride), scene.grid_step(),
                             static_cast<double>(scene.bytes()) / 1e6);
  if (stride > 1) made.summary += "; --max-mb takes more";
  if (scene.moved_points() > 0) {
    made.summary += fmt::format("; {} too far from the cloth for the view are shown nearer",
                                counted(scene.moved_points(), "position"));
  }
  page::Page page(title);
  const Html slider = Html{"<input type=\"range\" min=\"0\" step=\"1\" value=\"0\" aria-label=\"Frame\">"};
  const Html below = element("div", {{"id", "scrub"}, {"class", "scrub"}},
                             element("button", {{"type", "button"}, {"data-do", "play"}}, text("Play")) +
                                 element("div", {{"class", "track"}}, slider) + element("output", {}, {})) +
                     element("p", {{"class", "quiet"}, {"id", "summary"}},
                             text(made.summary + ". Space plays, comma and full stop go one frame back and on."));
  page.add_section(title, page::view_box(up, below), "player");
  scene.add_to(page);
  page::add_viewer(page);
  for (const char* script : {"scrubber.js", "player.js"}) page.add_script(page::asset(script));
  made.html = page.html();
  return made;
}

}  // namespace selvage::cli
