// A picture of measurements: what it holds, and the SVG that a browser shows of it.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace selvage::cli::plot {

/// On a logarithmic axis 0 has a place of its own, below all other numbers.
enum class ScaleKind { kLinear, kLogarithmic };

struct Axis {
  std::string label;  ///< with the unit
  ScaleKind kind = ScaleKind::kLogarithmic;
  std::optional<double> reference = std::nullopt;  ///< a grey line at this number
  std::vector<double> holds = {};                  ///< numbers that the axis shows, whatever the points are
};

/// Numbers from 0 up; one that is not finite is drawn at an end of its axis.
struct Point {
  double x = 0, y = 0;
  std::string row;           ///< all that the table says of it: shown where the mouse rests on the point
  std::string label = {};    ///< stands beside the point where there is room
  bool starts_line = false;  ///< no line leads to it from the point before
};

/// A guide is a broken grey line, for what is not measured.
enum class Look { kLineAndMarkers, kMarkers, kGuide };

/// Drawn with one colour and one marker wherever the name comes up again in a figure.
struct Series {
  std::string name;
  std::vector<Point> points;
  Look look = Look::kLineAndMarkers;
};

struct Curves {
  Axis x, y;
  std::vector<Series> series;

  /// At the end of the series of that name, which is made where there is none.
  void add(const std::string& name, Point point, Look look = Look::kLineAndMarkers);
};

/// Gives all of them the same scales: a place in one means what it means in the others.
void share_scales(const std::vector<Curves*>& panels);

struct Cell {
  std::string text;
  bool is_bad = false;  ///< in red
};

struct Bar {
  std::string label;
  double value = 0;
  std::vector<Cell> cells;  ///< one for each of the columns
  bool is_ours = false;     ///< in colour
  double pale = 0;          ///< up to this value the colour is pale
};

/// A bar a row, with columns of a table beside it.
struct Bars {
  Axis value;
  std::vector<std::string> columns;
  std::vector<Bar> bars;
};

/// Stands over the panels that follow it.
struct Heading {
  std::string text;
};

struct Figure {
  std::string title;
  std::vector<std::string> notes;  ///< lines below the title
  int columns = 2;                 ///< curves beside each other; bars have the whole width
  std::vector<std::variant<Heading, Curves, Bars>> panels;
};

/// One file that loads nothing and runs nothing; all words in it are text. The same figure makes the same bytes.
[[nodiscard]] std::string to_svg(const Figure& figure);

}  // namespace selvage::cli::plot
