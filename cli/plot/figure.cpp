#include "cli/plot/figure.h"

#include <algorithm>

#include <fmt/format.h>

#include "cli/plot/panels.h"
#include "cli/plot/svg.h"

namespace selvage::cli::plot {

using page::Html;

namespace {

constexpr double kWidth = 1080, kMargin = 20;
constexpr std::size_t kMostOfLine = 150;

/// Draws from above to below.
class Drawing {
 public:
  explicit Drawing(const Figure& figure) : figure_(figure), legend_(figure) {
    add_line(figure.title, {.size = 17, .is_bold = true, .most = 100}, 26);
    for (const std::string& note : figure.notes) add_line(note, {.colour = kQuiet, .most = kMostOfLine}, 17);
    y_ += 8;
    add_legend();
    for (const auto& panel : figure.panels) std::visit([this](const auto& p) { add(p); }, panel);
    end_row();
  }

  [[nodiscard]] std::string svg() const {
    const std::string height = pixels(y_ + kMargin);
    const Html whole = page::element(
        "svg",
        {{"xmlns", "http://www.w3.org/2000/svg"},
         {"width", pixels(kWidth)},
         {"height", height},
         {"viewBox", fmt::format("0 0 {} {}", pixels(kWidth), height)},
         {"font-family", "system-ui, 'DejaVu Sans', sans-serif"}},
        Html{"\n"} + title(figure_.title) + Html{"\n"} + rectangle(0, 0, kWidth, y_ + kMargin, "#ffffff") + drawn_);
    return whole.code + "\n";
  }

 private:
  void add_line(std::string_view text, const Words& style, double height) {
    y_ += height;
    drawn_ += words(kMargin, y_ - 6, text, style);
  }

  void add_legend() {
    double x = kMargin;
    const auto add_name = [&](const std::string& name, bool is_guide) {
      constexpr std::size_t kMost = 60;
      const double width = 36 + width_of(std::min(kMost, character_count(name)), 12);
      if (x > kMargin && x + width > kWidth - kMargin) {
        x = kMargin;
        y_ += 20;
      }
      drawn_ +=
          is_guide ? guide(fmt::format("M{} {}h20", pixels(x), pixels(y_ + 8))) : legend_.marker(name, x + 10, y_ + 8);
      drawn_ += words(x + 24, y_ + 12, name, {.most = kMost});
      x += width;
    };
    for (const std::string& name : legend_.names()) add_name(name, false);
    for (const std::string& name : legend_.guides()) add_name(name, true);
    if (x > kMargin) y_ += 26;
  }

  /// Where there are more beside each other they are less wide.
  [[nodiscard]] double curves_height() const { return figure_.columns > 2 ? 260 : 300; }

  void add(const Heading& heading) {
    end_row();
    add_line(heading.text, {.size = 13, .is_bold = true, .most = kMostOfLine - 20}, 26);
  }

  void add(const Curves& curves) {
    if (column_ == figure_.columns) end_row();
    const double width = (kWidth - 2 * kMargin) / figure_.columns;
    drawn_ += draw(curves, legend_, {kMargin + column_ * width, y_, width, curves_height()});
    ++column_;
  }

  void add(const Bars& bars) {
    end_row();
    drawn_ += draw(bars, {kMargin, y_, kWidth - 2 * kMargin, height_of(bars)});
    y_ += height_of(bars);
  }

  void end_row() {
    if (column_ > 0) y_ += curves_height();
    column_ = 0;
  }

  const Figure& figure_;
  Legend legend_;
  Html drawn_;
  double y_ = kMargin / 2;
  int column_ = 0;
};

}  // namespace

std::string to_svg(const Figure& figure) { return Drawing(figure).svg(); }

}  // namespace selvage::cli::plot
