#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "cli/plot/figure.h"
#include "cli/plot/scale.h"
#include "tests/cli/well_formed.h"

namespace selvage::cli::plot {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

TEST(PlotScale, NumbersAreShort) {
  const std::pair<double, const char*> cases[] = {
      {0, "0"},          {0.25, "0.25"},         {3, "3"},           {999.4, "999"},
      {999.7, "1,000"},  {12345.4, "12,345"},    {999'999.6, "10⁶"}, {2e6, "2·10⁶"},
      {1e-4, "0.0001"},  {9.99e-5, "9.99·10⁻⁵"}, {1e-12, "10⁻¹²"},   {3.217e-300, "3.22·10⁻³⁰⁰"},
      {kInfinity, "inf"}};
  for (const auto& [value, label] : cases) EXPECT_EQ(number_label(value), label) << value;
}

TEST(PlotScale, PlacesAscendWithinTheAxisWhateverTheNumbers) {
  const std::vector<double> sets[] = {
      {}, {0}, {1}, {7, 7.0001}, {0, 1e-17, 1}, {1, 1e6}, {5e-324, 1.7e308}, {kNan, 3, kInfinity, -1}};
  for (const std::vector<double>& values : sets) {
    for (const ScaleKind kind : {ScaleKind::kLinear, ScaleKind::kLogarithmic}) {
      const Scale scale(kind, values, 100, 400);
      const std::vector<Tick> ticks = scale.ticks();
      EXPECT_GE(ticks.size(), 2U) << ::testing::PrintToString(values);
      EXPECT_LE(ticks.size(), 10U) << ::testing::PrintToString(values);
      double before = -1;
      for (const Tick& tick : ticks) {
        EXPECT_LT(before, scale.place(tick.value)) << ::testing::PrintToString(values) << tick.label;
        before = scale.place(tick.value);
      }
      for (const double value : values) {
        EXPECT_TRUE(scale.place(value) >= 100 && scale.place(value) <= 400) << value;
      }
      EXPECT_EQ(scale.place(kNan), 100);
      EXPECT_EQ(scale.place(kInfinity), 400);
    }
  }
  const Scale errors(ScaleKind::kLogarithmic, {0, 1e-9, 1}, 100, 400),
      none(ScaleKind::kLogarithmic, {1e-9, 1}, 100, 400);
  EXPECT_EQ(errors.ticks().front().label, "0");
  EXPECT_LT(errors.place(0), errors.place(1e-9) - 20) << "0 is apart";
  EXPECT_NE(none.ticks().front().label, "0");
  EXPECT_GT(Scale(ScaleKind::kLogarithmic, {1, 9}, 400, 100).place(1), 300) << "upwards";
}

TEST(PlotFigure, IsTheSameBytesOfTheSameNumbers) {
  Curves curves{{"x"}, {"y, ms"}, {}};
  curves.add("a & b", {1, 0, "row 1"});
  curves.add("a & b", {10, 1e-9, "row 2"});
  curves.add("<", {kNan, kInfinity, "row 3"}, false);
  const Bars bars{{"time, ns"}, {"missed"}, {{std::string(80, 'n'), 12, {{"3", true}}, true}, {"none", 0, {{"0"}}}}};
  const Figure figure{"T", {"note"}, 2, {Heading{"H"}, curves, bars, curves, Bars{{"time"}, {}, {}}}};
  const std::string svg = to_svg(figure);
  EXPECT_EQ(svg, to_svg(figure));
  EXPECT_EQ(testing::fault_of_xml(svg), "");
  for (const std::string part :
       {">T</title>", ">T</text>", ">note</text>", ">H</text>", ">y, ms</text>", ">time, ns</text>", ">missed</text>",
        ">a &amp; b\nrow 2</title>", ">&lt;\nrow 3</title>", ">3</text>"}) {
    EXPECT_NE(svg.find(part), svg.npos) << part;
  }
  EXPECT_NE(svg.find(std::string(80, 'n') + "</title>" + std::string(29, 'n') + "…</text>"), svg.npos)
      << "cut, in full on hover";
}

}  // namespace selvage::cli::plot
