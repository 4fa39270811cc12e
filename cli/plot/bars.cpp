#include <algorithm>

#include "cli/plot/panels.h"
#include "cli/plot/scale.h"
#include "cli/plot/svg.h"

namespace selvage::cli::plot {

using page::Html;

namespace {

constexpr double kRow = 24, kHead = 24, kFoot = 48, kCell = 72;
constexpr std::size_t kMostOfLabel = 30;

}  // namespace

double height_of(const Bars& bars) { return kHead + kRow * static_cast<double>(bars.bars.size()) + kFoot; }

Html draw(const Bars& bars, const Box& box) {
  std::vector<double> values;
  std::size_t longest = 0;
  for (const Bar& bar : bars.bars) {
    values.push_back(bar.value);
    longest = std::max(longest, character_count(bar.label));
  }
  const double left = box.x + width_of(std::min(longest, kMostOfLabel), 12) + 12,
               right = box.x + box.width - kCell * static_cast<double>(bars.columns.size()) - 8, top = box.y + kHead,
               bottom = top + kRow * static_cast<double>(bars.bars.size());
  const auto cell_end = [&](std::size_t column) { return right + kCell * static_cast<double>(column + 1); };
  const Scale scale(bars.value.kind, values, left + (bars.value.kind == ScaleKind::kLinear ? 0 : 8), right);
  Html drawn;
  for (const Tick& tick : scale.ticks()) {
    const double at = scale.place(tick.value);
    drawn += line(at, top, at, bottom, kGrid) +
             words(at, bottom + 16, tick.label, {.anchor = Anchor::kMiddle, .size = 11, .colour = kQuiet});
  }
  for (std::size_t i = 0; i < bars.columns.size(); ++i) {
    drawn += words(cell_end(i), top - 8, bars.columns[i], {.anchor = Anchor::kEnd, .size = 11, .colour = kQuiet});
  }
  for (std::size_t i = 0; i < bars.bars.size(); ++i) {
    const Bar& bar = bars.bars[i];
    const double y = top + kRow * static_cast<double>(i), base = y + kRow / 2 + 4;
    const double pale_end = scale.place(std::min(bar.pale, bar.value));
    if (bar.pale > 0) drawn += rectangle(left, y + 5, pale_end - left, kRow - 10, kPale);
    const double begin = bar.pale > 0 ? pale_end : left;
    drawn += rectangle(begin, y + 5, scale.place(bar.value) - begin, kRow - 10, bar.is_ours ? kOurs : kOthers);
    drawn += words(left - 8, base, bar.label, {.anchor = Anchor::kEnd, .is_bold = bar.is_ours, .most = kMostOfLabel});
    for (std::size_t k = 0; k < bar.cells.size(); ++k) {
      drawn +=
          words(cell_end(k), base, bar.cells[k].text,
                {.anchor = Anchor::kEnd, .colour = bar.cells[k].is_bad ? kBad : kInk, .is_bold = bar.cells[k].is_bad});
    }
  }
  drawn += line(left, top, left, bottom, kQuiet) + line(left, bottom, right, bottom, kQuiet);
  return drawn + words((left + right) / 2, bottom + 35, bars.value.label, {.anchor = Anchor::kMiddle});
}

}  // namespace selvage::cli::plot
