// From numbers to places along an axis, and the numbers that are written on it.
#pragma once

#include <string>
#include <vector>

#include "cli/plot/figure.h"

namespace selvage::cli::plot {

struct Tick {
  double value = 0;
  std::string label;
};

class Scale {
 public:
  /// Holds all of the `values` between the places `begin` and `end`; there may be none.
  Scale(ScaleKind kind, const std::vector<double>& values, double begin, double end);

  /// What is not a number, or below 0, is at the beginning, and infinity at the end.
  [[nodiscard]] double place(double value) const;
  /// Ascending; at least two.
  [[nodiscard]] std::vector<Tick> ticks() const;

 private:
  ScaleKind kind_;
  double begin_, end_;
  double low_ = 0, high_ = 1;  // low_: of a logarithmic axis, the lowest number above 0
  bool has_zero_ = false;      // of a logarithmic axis: left of low_
};

/// 0.25, 12,345, or 3·10⁻⁷: three digits, or a whole number.
[[nodiscard]] std::string number_label(double value);

}  // namespace selvage::cli::plot
