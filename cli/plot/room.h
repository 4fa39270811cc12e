// Where a word may stand beside a point of a panel, without covering others.
#pragma once

#include <string_view>
#include <vector>

#include "cli/plot/panels.h"
#include "page/html.h"

namespace selvage::cli::plot {

class Room {
 public:
  explicit Room(const Box& panel) : panel_(panel) {}

  void take_marker(double x, double y);
  /// Beside the marker there, and takes that room; nothing where there is none.
  [[nodiscard]] page::Html label(double x, double y, std::string_view text, std::string_view colour);

 private:
  [[nodiscard]] bool is_free(const Box& box) const;

  Box panel_;
  std::vector<Box> taken_;
};

}  // namespace selvage::cli::plot
