#include "cli/plot/scale.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include <fmt/format.h>

namespace selvage::cli::plot {
namespace {

constexpr double kZeroRoom = 26;  // pixels from the place of 0 to the lowest other number
constexpr int kMostTicks = 7;
constexpr double kLeast = 1e-300, kMost = 1e300;  // beyond these all are drawn at the ends

/// The exponent's digits as superscripts.
std::string superscript(int number) {
  constexpr std::string_view kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text;
  for (const char c : std::to_string(number)) text += c == '-' ? "⁻" : kDigits[c - '0'];
  return text;
}

/// The least of 1, 2, 5, 10, ... that is not below.
double round_up(double value) {
  const double decade = std::pow(10, std::floor(std::log10(value)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * decade >= value * (1 - 1e-9)) return factor * decade;
  }
  return 10 * decade;
}

}  // namespace

std::string number_label(double value) {
  if (value == 0) return "0";
  if (!std::isfinite(value)) return fmt::format("{}", value);
  const double size = std::abs(value);
  if (size >= 999.5 && size < 999'999.5) {
    std::string text = fmt::format("{:.0f}", value);
    return text.insert(text.size() - 3, ",");
  }
  if (size >= 1e-4 && size < 999.5) return fmt::format("{:.3g}", value);
  const std::string scientific = fmt::format("{:.3g}", value);  // so large or small a number has an exponent
  const std::size_t e = scientific.find('e');
  const std::string power = "10" + superscript(std::stoi(scientific.substr(e + 1)));
  return scientific.substr(0, e) == "1" ? power : scientific.substr(0, e) + "·" + power;
}

Scale::Scale(ScaleKind kind, const std::vector<double>& values, double begin, double end)
    : kind_(kind), begin_(begin), end_(end) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const double value : values) {
    if (value > 0 && std::isfinite(value)) {
      least = std::min(least, std::max(value, kLeast));
      most = std::max(most, std::min(value, kMost));
    } else if (!std::isinf(value)) {
      has_zero_ = true;
    }
  }
  if (most == 0) least = most = 1;
  if (kind == ScaleKind::kLinear) {
    const double step = round_up(most / (kMostTicks - 2));
    high_ = step * std::ceil(most / step * (1 - 1e-9));  // shares up to 1 end at 1, whatever is rounded
    return;
  }
  const double margin = std::max(1.3, std::sqrt(12 / (most / least)));  // so that there is a decade, and two ticks
  low_ = least / margin;
  high_ = most * margin;
}

double Scale::place(double value) const {
  if (std::isnan(value)) value = 0;
  value = std::clamp(value, 0.0, high_);
  if (kind_ == ScaleKind::kLinear) return begin_ + value / high_ * (end_ - begin_);
  const double first = has_zero_ ? begin_ + std::copysign(kZeroRoom, end_ - begin_) : begin_;
  if (value < low_) return begin_;
  return first + (std::log(value) - std::log(low_)) / (std::log(high_) - std::log(low_)) * (end_ - first);
}

std::vector<Tick> Scale::ticks() const {
  std::vector<Tick> ticks;
  const auto add = [&](double value) { ticks.push_back({value, number_label(value)}); };
  if (kind_ == ScaleKind::kLinear) {
    const double step = round_up(high_ / (kMostTicks - 1));
    for (int i = 0; i * step <= high_ * (1 + 1e-9); ++i) add(i * step);
    return ticks;
  }
  if (has_zero_) add(0);
  const int first = static_cast<int>(std::floor(std::log10(low_))),
            last = static_cast<int>(std::ceil(std::log10(high_)));
  const double decades = std::log10(high_) - std::log10(low_);
  const int every = 1 + static_cast<int>(decades) / kMostTicks;
  std::vector<int> factors{1};
  if (decades < 3) factors = {1, 3};
  if (decades < 1.6) factors = {1, 2, 5};
  for (int k = first; k <= last; ++k) {
    if (k % every != 0) continue;
    for (const int factor : factors) {
      const double value = factor * std::pow(10, k);
      if (value >= low_ && value <= high_) add(value);
    }
  }
  return ticks;
}

}  // namespace selvage::cli::plot
