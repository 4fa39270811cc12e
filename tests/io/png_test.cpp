#include "io/format/png.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include "io/file/byte_order.h"
#include "io/file/checksum.h"
#include "tests/io/support.h"

namespace selvage::io {
namespace {

using testing::expect_error;

/// A decoder written from the specification, for the one kind of PNG that the writer makes: no filter is assumed.
std::vector<std::uint8_t> decode(const std::string& png, std::uint32_t width, std::uint32_t height) {
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  std::string compressed;
  std::vector<std::string> types;
  for (std::size_t at = 8; at < png.size();) {
    const auto size = load<std::uint32_t>(png.data() + at, std::endian::big);
    const std::string typed = png.substr(at + 4, 4 + size);
    EXPECT_EQ(load<std::uint32_t>(png.data() + at + 8 + size, std::endian::big), crc32(typed));
    types.push_back(typed.substr(0, 4));
    if (types.back() == "IHDR") {
      EXPECT_EQ(load<std::uint32_t>(typed.data() + 4, std::endian::big), width);
      EXPECT_EQ(load<std::uint32_t>(typed.data() + 8, std::endian::big), height);
      EXPECT_EQ(typed.substr(12), std::string("\x08\x02\0\0\0", 5));
    }
    if (types.back() == "IDAT") compressed += typed.substr(4);
    at += 12 + size;
  }
  EXPECT_EQ(types.front(), "IHDR");
  EXPECT_EQ(types.back(), "IEND");

  const std::size_t row_size = 3 * std::size_t{width};
  std::vector<std::uint8_t> rows((row_size + 1) * height), pixels;
  uLongf rows_size = rows.size();
  EXPECT_EQ(::uncompress(rows.data(), &rows_size, reinterpret_cast<const Bytef*>(compressed.data()), compressed.size()),
            Z_OK);
  EXPECT_EQ(rows_size, rows.size());
  for (std::size_t y = 0; y < height; ++y) {
    const std::uint8_t* row = rows.data() + y * (row_size + 1);
    for (std::size_t i = 0; i < row_size; ++i) {
      const int a = i >= 3 ? pixels[y * row_size + i - 3] : 0;
      const int b = y > 0 ? pixels[(y - 1) * row_size + i] : 0;
      const int c = i >= 3 && y > 0 ? pixels[(y - 1) * row_size + i - 3] : 0;
      const int pa = std::abs(b - c), pb = std::abs(a - c), pc = std::abs(a + b - 2 * c);
      const int nearest = pa <= pb && pa <= pc ? a : pb <= pc ? b : c;
      const int predictions[] = {0, a, b, (a + b) / 2, nearest};
      pixels.push_back(static_cast<std::uint8_t>(row[1 + i] + predictions[row[0]]));
    }
  }
  return pixels;
}

TEST(Png, PixelsComeBack) {
  for (const auto& [width, height] : {std::pair{1, 1}, {7, 5}, {640, 480}}) {
    Picture picture = {width, height, {}};
    std::uint32_t state = 1;
    for (int i = 0; i < 3 * width * height; ++i) {
      state = state * 1664525 + 1013904223;
      picture.rgb.push_back(static_cast<std::uint8_t>(i % 3 == 0 ? state >> 24 : static_cast<std::uint32_t>(i / 50)));
    }
    EXPECT_EQ(decode(png_bytes(picture), static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height)),
              picture.rgb);
  }
}

TEST(Png, FileIsWritten) {
  const testing::TemporaryFolder folder;
  const Picture picture = {1, 1, {1, 2, 3}};
  write_png(folder / "a.png", picture);
  EXPECT_EQ(testing::slurp(folder / "a.png"), png_bytes(picture));
}

TEST(Png, PixelsMustFillThePicture) {
  expect_error(ErrorKind::kBadInput, "do not fill 2 by 2", [] {
    (void)png_bytes({2, 2, std::vector<std::uint8_t>(11)});
  });
  expect_error(ErrorKind::kBadInput, "do not fill 0 by 0", [] { (void)png_bytes({0, 0, {}}); });
  expect_error(ErrorKind::kBadInput, "do not fill -1 by -1", [] { (void)png_bytes({-1, -1, {1, 2, 3}}); });
}

}  // namespace
}  // namespace selvage::io
