// A scene comes back from its page as assets/unpack.js and assets/scene.js read it.
#include "page/scene.h"

#include <cmath>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>
#include <zlib.h>

#include "page/json.h"
#include "page/packed.h"

namespace selvage::page {
namespace {

constexpr std::size_t kNoLimit = std::size_t{1} << 40;

std::string from_base64(const std::string& text) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    bits = bits << 6 | static_cast<std::uint32_t>(digits.find(c));
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 255);
  }
  return bytes;
}

std::vector<std::int32_t> unpack_integers(const std::string& text, std::size_t stride) {
  const std::string deflated = from_base64(text);
  std::string planes(std::size_t{1} << 20, '\0');
  uLongf size = planes.size();
  const int status = ::uncompress(reinterpret_cast<Bytef*>(planes.data()), &size,
                                  reinterpret_cast<const Bytef*>(deflated.data()), deflated.size());
  if (status != Z_OK) throw std::runtime_error("no zlib stream");
  const std::size_t count = size / 4;
  std::vector<std::int32_t> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t folded = 0;
    for (std::size_t plane = 0; plane < 4; ++plane) {
      folded |= std::uint32_t{static_cast<std::uint8_t>(planes[plane * count + i])} << (8 * plane);
    }
    const std::uint32_t difference = folded >> 1 ^ (0u - (folded & 1));
    values[i] =
        static_cast<std::int32_t>(difference + (i < stride ? 0u : static_cast<std::uint32_t>(values[i - stride])));
  }
  return values;
}

/// The packed text with this id.
std::string packed_data(const std::string& html, const std::string& id) {
  const std::string start = "<script type=\"text/plain\" id=\"" + id + "\">";
  const std::size_t begin = html.find(start);
  if (begin == html.npos) return "";
  return html.substr(begin + start.size(), html.find('<', begin + start.size()) - begin - start.size());
}

struct Sheet {
  std::vector<Point> points;
  std::vector<Triangle> triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  std::vector<std::uint8_t> is_body = {1, 0, 0};

  explicit Sheet(double scale, unsigned seed = 1) {
    std::mt19937 generator(seed);
    for (int i = 0; i < 9; ++i) {
      Point point;
      for (double& x : point) x = scale * (static_cast<double>(generator()) / 4294967296.0 - 0.25);
      points.push_back(point);
    }
  }
  [[nodiscard]] SceneFrame frame(std::int64_t number) const {
    return {number, "f<" + std::to_string(number), double(number), points, triangles, is_body};
  }
  [[nodiscard]] Box box() const {
    Box box;
    for (const Point& point : points) box.add(point);
    return box;
  }
};

std::string html_of(const Scene& scene) {
  Page page("t");
  scene.add_to(page);
  return page.html();
}

}  // namespace

TEST(PagePacked, IntegersComeBack) {
  const std::vector<std::int32_t> hard = {0, 1, -1, 2147483647, -2147483647 - 1, 5, 2147483647, -7, 0, -1};
  for (const std::size_t stride : {1U, 3U}) EXPECT_EQ(unpack_integers(packed_integers(hard, stride), stride), hard);
}

TEST(PageScene, PositionsAreWithinHalfAGridStepAtEveryScale) {
  for (const double scale : {1.0, 3e-7, 1e12, 0x1p-1060, 0x1p1020}) {
    const Sheet sheet(scale);
    const ViewUnits units = ViewUnits::of(sheet.box());
    Scene scene(sheet.box(), 20, Prediction::kNone);
    ASSERT_TRUE(scene.add_frame(sheet.frame(7), kNoLimit));
    const std::vector<std::int32_t> grid = unpack_integers(packed_data(html_of(scene), "frame-0"), 3);
    ASSERT_EQ(grid.size(), 27U) << scale;
    double largest = 0;
    for (std::size_t i = 0; i < 9; ++i) {
      const Point view = units.to_view(sheet.points[i]);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_LE(std::abs(std::ldexp(grid[3 * i + k], -20) - view[k]), std::ldexp(0.5, -20)) << scale;
        largest = std::max(largest, std::abs(view[k]));
      }
    }
    EXPECT_GT(largest, 0.4) << "the box fills the view";
    EXPECT_LE(largest, 1);
    EXPECT_EQ(scene.moved_points(), 0);
  }
}

TEST(PageScene, TheGridStepIsInTheUnitOfTheInput) {
  Box box;
  box.add({-3, 0, 0});
  box.add({5, 0, 0});
  EXPECT_EQ(Scene(box, 4, Prediction::kNone).grid_step(), 4.0 / 16);
  Box point;
  point.add({7, 7, 7});
  EXPECT_GT(Scene(point, 4, Prediction::kNone).grid_step(), 0) << "a box without a size";
}

TEST(PageScene, ClothComesFirstAndFacesAreSharedUntilTheyChange) {
  Sheet sheet(1);
  Scene scene(sheet.box(), 16, Prediction::kNone);
  ASSERT_TRUE(scene.add_frame(sheet.frame(0), kNoLimit));
  ASSERT_TRUE(scene.add_frame(sheet.frame(1), kNoLimit));
  sheet.is_body = {0, 0, 0};
  ASSERT_TRUE(scene.add_frame(sheet.frame(2), kNoLimit));
  const std::string html = html_of(scene);
  EXPECT_EQ(unpack_integers(packed_data(html, "surface-0"), 3), (std::vector<std::int32_t>{3, 4, 5, 6, 7, 8, 0, 1, 2}));
  EXPECT_EQ(unpack_integers(packed_data(html, "surface-1"), 3), (std::vector<std::int32_t>{0, 1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_NE(html.find("\"surfaces\": [{\"cloth\": 2}, {\"cloth\": 3}]"), html.npos);
  EXPECT_NE(html.find("{\"frame\": 2, \"name\": \"f\\u003c2\", \"time\": 2, \"surface\": 1, \"predicted\": false}"),
            html.npos);
}

// The same faces in the same order, of which the last ones are cloth from some frame on.
TEST(PageScene, ASurfaceHasAsManyFacesOfClothAsItHas) {
  Sheet sheet(1);
  sheet.is_body = {0, 0, 1};
  Scene scene(sheet.box(), 16, Prediction::kNone);
  ASSERT_TRUE(scene.add_frame(sheet.frame(0), kNoLimit));
  sheet.is_body = {0, 0, 0};
  ASSERT_TRUE(scene.add_frame(sheet.frame(1), kNoLimit));
  EXPECT_NE(html_of(scene).find("\"surfaces\": [{\"cloth\": 2}, {\"cloth\": 3}]"), std::string::npos);
}

TEST(PageScene, PredictedFramesAddUp) {
  const std::vector<Sheet> sheets = {Sheet(1), Sheet(1, 2), Sheet(1, 3)};
  Scene scene(sheets[0].box(), 16, Prediction::kPrevious), alone(sheets[0].box(), 16, Prediction::kNone);
  for (std::size_t n = 0; n < sheets.size(); ++n) {
    const SceneFrame frame = sheets[n].frame(static_cast<std::int64_t>(n));
    ASSERT_TRUE(scene.add_frame(frame, kNoLimit) && alone.add_frame(frame, kNoLimit));
  }
  std::vector<std::int32_t> sum(27, 0);
  for (std::size_t n = 0; n < sheets.size(); ++n) {  // each is the difference to the one before
    const std::string id = "frame-" + std::to_string(n);
    const std::vector<std::int32_t> difference = unpack_integers(packed_data(html_of(scene), id), 3);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += difference.at(i);
    EXPECT_EQ(sum, unpack_integers(packed_data(html_of(alone), id), 3)) << n;
  }
}

TEST(PageScene, WhatDoesNotFitIsLeftOut) {
  const Sheet first(1), second(1, 2);
  Scene scene(first.box(), 16, Prediction::kPrevious);
  EXPECT_FALSE(scene.add_frame(first.frame(0), 10));
  EXPECT_EQ(scene.bytes(), 0U);
  ASSERT_TRUE(scene.add_frame(first.frame(0), kNoLimit));
  const std::size_t full = scene.bytes();
  const std::string before = html_of(scene);
  EXPECT_FALSE(scene.add_frame(second.frame(1), full));
  EXPECT_EQ(html_of(scene), before);
  EXPECT_GE(before.size(), full) << "the bytes are those of the page";
}

TEST(PageScene, WhatIsTooFarAwayIsMovedAndCounted) {
  Sheet sheet(1);
  const Box stage = sheet.box();
  sheet.points[4] = {1e9, 0, -1e300};
  Scene scene(stage, 20, Prediction::kNone);
  ASSERT_TRUE(scene.add_frame(sheet.frame(0), kNoLimit));
  EXPECT_EQ(scene.moved_points(), 1);
  const std::vector<std::int32_t> grid = unpack_integers(packed_data(html_of(scene), "frame-0"), 3);
  EXPECT_EQ(grid.at(12), 2147483647);
  EXPECT_EQ(grid.at(14), -2147483647);
}

TEST(PageJson, StringsAndNumbersComeBack) {
  EXPECT_EQ(json_string("a\"b\\c\n\x01"), "\"a\\\"b\\\\c\\u000a\\u0001\"");
  EXPECT_EQ(json_string("\xc3\xa9\xff\xe2\x82z"), "\"\xc3\xa9\xef\xbf\xbd\xef\xbf\xbd\xef\xbf\xbdz\"");
  EXPECT_EQ(std::stod(json_number(0.1)), 0.1);
}

}  // namespace selvage::page
