#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cli/plot/figure.h"
#include "cli/plot/panels.h"
#include "cli/plot/room.h"
#include "cli/plot/scale.h"
#include "tests/cli/well_formed.h"

namespace selvage::cli::plot {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();

/// The elements of `kind` in an SVG.
std::vector<std::string> elements(const std::string& svg, const std::string& kind) {
  std::vector<std::string> found;
  for (std::size_t at = svg.find("<" + kind); at != svg.npos; at = svg.find("<" + kind, at + 1)) {
    found.push_back(svg.substr(at, svg.find('>', at) - at));
  }
  return found;
}

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
  EXPECT_EQ(Scale(ScaleKind::kLinear, {0, 1}, 100, 400).place(1), 400) << "all of a whole is at the end";
}

TEST(PlotFigure, IsTheSameBytesOfTheSameNumbers) {
  Curves curves{{"x"}, {"y, ms"}, {}};
  curves.add("a & b", {1, 0, "row 1"});
  curves.add("a & b", {10, 1e-9, "row 2"});
  curves.add("<", {kNan, kInfinity, "row 3"}, Look::kMarkers);
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

TEST(PlotFigure, SharedScalesPutAPointAtTheSamePlaceInEveryPanel) {
  Curves low{{"x"}, {"y"}, {}}, high = low;
  low.add("both", {2, 0.5, ""});
  low.add("low", {1, 0, ""});
  high.add("both", {2, 0.5, ""});
  high.add("high", {1000, 1, ""});
  const Box box{0, 0, 300, 300};
  const auto marker = [&](const Curves& curves) {
    return elements(draw(curves, Legend({"", {}, 1, {low, high}}), box).code, "path").front();
  };
  EXPECT_NE(marker(low), marker(high));
  share_scales({&low, &high});
  EXPECT_EQ(marker(low), marker(high));
}

TEST(PlotFigure, AReferenceIsALineWhereTheAxisHoldsIt) {
  Curves curves{{"x"}, {"y"}, {}};
  curves.add("a", {1, 1, ""});
  const Box box{0, 0, 300, 300};
  const auto references = [&] {
    const std::string code = draw(curves, Legend({"", {}, 1, {curves}}), box).code;
    std::size_t count = 0;
    for (const std::string& line : elements(code, "line")) count += line.find(kReference) != line.npos ? 1 : 0;
    return count;
  };
  EXPECT_EQ(references(), 0U);
  curves.x.reference = 1;
  EXPECT_EQ(references(), 1U);
  curves.y.reference = 1;
  EXPECT_EQ(references(), 2U);
}

TEST(PlotFigure, AnAxisShowsNumbersThatNoPointHas) {
  Curves curves{{"x"}, {"y"}, {}};
  curves.add("a", {1, 0, ""});
  const auto has_tick = [&](const char* text) {
    return draw(curves, Legend({"", {}, 1, {curves}}), {0, 0, 300, 300}).code.find(text) != std::string::npos;
  };
  EXPECT_FALSE(has_tick(">0.01</text>"));
  curves.y.holds = {0.001, 1};
  EXPECT_TRUE(has_tick(">0.01</text>"));
}

TEST(PlotFigure, AGuideIsABrokenLineWithoutMarkersAndTheLegendNamesIt) {
  Curves curves{{"x"}, {"y"}, {}};
  curves.add("measured", {1, 1, ""});
  curves.add("wished for", {1, 1, ""}, Look::kGuide);
  curves.add("wished for", {10, 10, ""}, Look::kGuide);
  const std::string svg = to_svg({"", {}, 1, {curves}});
  std::size_t broken = 0;
  const std::vector<std::string> paths = elements(svg, "path");
  for (const std::string& path : paths) broken += path.find("stroke-dasharray") != path.npos ? 1 : 0;
  EXPECT_EQ(broken, 2U) << "in the panel and in the legend";
  EXPECT_EQ(paths.size(), broken + 2) << "one marker, in the panel and in the legend";
  EXPECT_NE(svg.find(">wished for</text>"), svg.npos);
}

TEST(PlotFigure, ALineEndsWhereAPointStartsAnother) {
  Curves curves{{"x"}, {"y"}, {}};
  for (const double x : {1, 2, 3, 4}) curves.add("a", {x, x, "", "", x == 3});
  const std::string line = elements(draw(curves, Legend({"", {}, 1, {curves}}), {0, 0, 300, 300}).code, "path").front();
  EXPECT_EQ(std::ranges::count(line, 'M'), 2) << line;
  EXPECT_EQ(std::ranges::count(line, 'L'), 2) << line;
}

TEST(PlotFigure, ABarIsPaleUpToWhatTheRowBeforeHad) {
  const auto widths = [](double value, double pale) {
    std::vector<double> found;
    const Bars bars{{"", ScaleKind::kLinear}, {}, {{"", 10, {}, true}, {"", value, {}, true, pale}}};
    for (const std::string& bar : elements(draw(bars, {0, 0, 500, 200}).code, "rect")) {
      found.push_back(std::stod(bar.substr(bar.find("width=\"") + 7)));
    }
    return found;
  };
  const auto grown = widths(8, 4), shrunk = widths(4, 8);
  ASSERT_EQ(grown.size(), 3U);
  EXPECT_NEAR(grown[1], 0.4 * grown[0], 0.2);
  EXPECT_NEAR(grown[2], 0.4 * grown[0], 0.2);
  ASSERT_EQ(shrunk.size(), 3U);
  EXPECT_NEAR(shrunk[1], 0.4 * shrunk[0], 0.2) << "nothing was added";
  EXPECT_EQ(shrunk[2], 0);
}

TEST(PlotRoom, ALabelStandsWhereItCoversNothingOrNowhere) {
  Room room({0, 0, 200, 100});
  room.take_marker(100, 50);
  std::vector<std::string> places;
  for (int i = 0; i < 7; ++i) {
    const std::vector<std::string> text = elements(room.label(100, 50, "0.001", "#000000").code, "text");
    if (i == 6) {
      EXPECT_TRUE(text.empty()) << "all room is taken";
    } else {
      ASSERT_EQ(text.size(), 1U) << i;
      EXPECT_EQ(std::ranges::count(places, text[0]), 0) << text[0];
      places.push_back(text[0]);
    }
  }
  Room full({0, 0, 200, 100});
  full.take_marker(100, 50);
  for (const double y : {40, 50, 60}) {
    for (double x = 10; x < 200; x += 10) full.take_marker(x, y);
  }
  EXPECT_EQ(full.label(100, 50, "0.001", "#000000").code, "") << "markers are not covered";
  Room edge({0, 0, 103, 100});
  EXPECT_EQ(edge.label(100, 50, "0.001", "#000000").code.find("translate(1"), std::string::npos) << "within the panel";
}

}  // namespace selvage::cli::plot
