#include "cli/render/contact_sheet.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <fmt/format.h>

#include "cli/process/exit_code.h"
#include "cli/render/bitmap_font.h"
#include "cli/render/renderer.h"

namespace selvage::cli {
namespace {

constexpr int kGap = 6;                                          // pixels between tiles
constexpr std::array<std::uint8_t, 3> kPaper = {250, 250, 248};  // behind the tiles
constexpr std::array<std::uint8_t, 3> kInk = {45, 50, 60};
constexpr int kTextScale = 2;
constexpr std::size_t kMaxPixels = 100'000'000;  // the sheet, a tile as large, and the PNG in the making: 0.9 GB

void paste(const io::Picture& tile, int x, int y, io::Picture& sheet) {
  for (int row = 0; row < tile.height; ++row) {
    const auto from = tile.rgb.begin() + std::ptrdiff_t{row} * tile.width * 3;
    std::copy(from, from + std::ptrdiff_t{tile.width} * 3,
              sheet.rgb.begin() + ((std::ptrdiff_t{y} + row) * sheet.width + x) * 3);
  }
}

}  // namespace

std::vector<std::size_t> spread_frames(const io::SequenceReader& sequence, std::size_t count) {
  const std::size_t total = sequence.frame_count();
  std::vector<std::size_t> frames;
  if (total == 0 || count == 0) return frames;
  const auto half_time = [&](std::size_t frame) { return sequence.time(frame) / 2; };  // whose difference is finite
  const double begin = half_time(0), end = half_time(total - 1);
  std::size_t frame = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double wanted = count == 1 ? end : begin + (end - begin) * (double(i) / double(count - 1));
    while (frame + 1 < total && std::abs(half_time(frame + 1) - wanted) <= std::abs(half_time(frame) - wanted)) {
      ++frame;
    }
    if (frames.empty() || frames.back() != frame) frames.push_back(frame);
  }
  return frames;
}

std::optional<io::Picture> render_sheet(const io::SequenceReader& sequence, const SheetOptions& options,
                                        const std::function<bool(std::size_t, std::size_t)>& progress) {
  const int columns = std::min(options.columns, static_cast<int>(options.frames.size()));
  constexpr int kSmallestTile = 60;  // pixels; below it the label hides the picture
  if (options.width < columns * (kSmallestTile + kGap) + kGap) {
    throw UsageError(fmt::format("--width {} is too small for {} columns", options.width, columns));
  }
  const int rows = (static_cast<int>(options.frames.size()) + columns - 1) / columns;
  const int tile_width = (options.width - kGap * (columns + 1)) / columns, tile_height = tile_width * 3 / 4;
  io::Picture sheet{options.width, rows * (tile_height + kGap) + kGap, {}};
  const std::size_t pixels = static_cast<std::size_t>(sheet.width) * static_cast<std::size_t>(sheet.height);
  if (pixels > kMaxPixels) {
    throw UsageError(fmt::format("a sheet of {} by {} pixels is too large; choose a smaller --width or more --columns",
                                 sheet.width, sheet.height));
  }
  Stage stage;
  for (const std::size_t frame : options.frames) stage.add_cloth(make_render_surface(sequence.frame(frame)));
  if (stage.points.empty()) throw io::Error(io::ErrorKind::kBadInput, sequence.frame_name(0) + ": no faces to draw");

  const bool is_timed = io::has_times(sequence);
  sheet.rgb.resize(3 * pixels);
  for (std::size_t i = 0; i < sheet.rgb.size(); ++i) sheet.rgb[i] = kPaper[i % 3];
  for (std::size_t n = 0; n < options.frames.size(); ++n) {
    const std::size_t frame = options.frames[n];
    std::optional<io::Picture> tile =
        render(make_render_surface(sequence.frame(frame)), options.view, stage, tile_width, tile_height,
               [&] { return progress(n, options.frames.size()); });
    if (!tile) return std::nullopt;
    const std::string time = is_timed ? fmt::format("   {:.2f} s", sequence.time(frame)) : "";
    draw_text(*tile, 10, 8, kTextScale, fmt::format("frame {}{}", frame, time), kInk);
    const int column = static_cast<int>(n) % columns, row = static_cast<int>(n) / columns;
    paste(*tile, kGap + column * (tile_width + kGap), kGap + row * (tile_height + kGap), sheet);
  }
  return sheet;
}

}  // namespace selvage::cli
