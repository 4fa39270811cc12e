#include "io/format/npy.h"

#include <gtest/gtest.h>

#include "io/file/byte_order.h"
#include "tests/io/npy_builder.h"
#include "tests/io/random_doubles.h"
#include "tests/io/support.h"
#include "tests/property.h"

namespace selvage::io {
namespace {

using testing::check_property;
using testing::dictionary;
using testing::expect_error;
using testing::npy;
using testing::numbers;
using testing::same_bits;

TEST(Npy, prop_float64_comes_back_bit_for_bit) {
  check_property(300, 1, [] {
    const Points points = *testing::finite_points();
    const NpyPoints read = parse_npy_points(npy_bytes(points, Precision::kFloat64, "a"), "a");
    RC_ASSERT(same_bits(read.points, points));
    RC_ASSERT(read.precision == Precision::kFloat64);
  });
}

TEST(Npy, prop_float32_comes_back_exactly_or_is_refused) {
  check_property(300, 2, [] {
    Points points = *testing::finite_points();
    bool is_lattice = true;
    for (const auto& point : points) {
      for (const double x : point) is_lattice = is_lattice && testing::to_lattice(x) == x;
    }
    if (!is_lattice) {
      expect_error(ErrorKind::kBadInput, "float32 lattice", [&] { (void)npy_bytes(points, Precision::kFloat32, "a"); });
    }
    for (auto& point : points) {
      for (double& x : point) x = testing::to_lattice(x);
    }
    const NpyPoints read = parse_npy_points(npy_bytes(points, Precision::kFloat32, "a"), "a");
    RC_ASSERT(same_bits(read.points, points));
    RC_ASSERT(read.precision == Precision::kFloat32);
  });
}

TEST(Npy, TrianglesComeBack) {
  const Triangles triangles = {{0, 1, 2}, {2, 1, 3}, {2147483647, 0, 7}};
  EXPECT_EQ(parse_npy_triangles(npy_bytes(triangles), "a"), triangles);
  EXPECT_EQ(parse_npy_triangles(npy_bytes(Triangles{}), "a"), Triangles{});
}

TEST(Npy, HeaderIsNumpysOwn) {
  // What numpy 1.24 writes for np.array([[1., 2., 3.]]).
  std::string expected("\x93NUMPY\x01\x00\x76\x00", 10);
  expected += "{'descr': '<f8', 'fortran_order': False, 'shape': (1, 3), }";
  expected.resize(127, ' ');
  expected += '\n';
  expected += numbers<double>({1, 2, 3});
  EXPECT_EQ(npy_bytes({{1, 2, 3}}, Precision::kFloat64, "a"), expected);
}

TEST(Npy, AllIntegerTypesAndOrders) {
  const Triangles expected = {{0, 1, 2}, {3, 1, 0}};
  const auto check = [&]<typename T>(T, const std::string& type) {
    EXPECT_EQ(parse_npy_triangles(npy(dictionary("<" + type, "(2, 3)"), numbers<T>({0, 1, 2, 3, 1, 0})), "a"),
              expected);
    EXPECT_EQ(parse_npy_triangles(
                  npy(dictionary(">" + type, "(2, 3)"), numbers<T>({0, 1, 2, 3, 1, 0}, std::endian::big)), "a"),
              expected);
  };
  check(std::int8_t{}, "i1");
  check(std::uint8_t{}, "u1");
  check(std::int16_t{}, "i2");
  check(std::uint16_t{}, "u2");
  check(std::int32_t{}, "i4");
  check(std::uint32_t{}, "u4");
  check(std::int64_t{}, "i8");
  check(std::uint64_t{}, "u8");
  EXPECT_EQ(parse_npy_triangles(npy(dictionary("|u1", "(1, 3)"), numbers<std::uint8_t>({0, 1, 2})), "a").size(), 1u);
}

TEST(Npy, FortranOrderIsTransposed) {
  const Points expected = {{1, 2, 3}, {4, 5, 6}};
  EXPECT_EQ(parse_npy_points(npy(dictionary("<f8", "(2, 3)", true), numbers<double>({1, 4, 2, 5, 3, 6})), "a").points,
            expected);
  EXPECT_EQ(parse_npy_points(
                npy(dictionary(">f4", "(2, 3)", true), numbers<float>({1, 4, 2, 5, 3, 6}, std::endian::big)), "a")
                .points,
            expected);
}

TEST(Npy, LaterVersionsAndOtherSpellingsOfTheHeader) {
  const std::string data = numbers<double>({1, 2, 3});
  const Points expected = {{1, 2, 3}};
  for (const char version : {'\1', '\2', '\3'}) {
    EXPECT_EQ(parse_npy_points(npy(dictionary("<f8", "(1, 3)"), data, version), "a").points, expected);
  }
  EXPECT_EQ(parse_npy_points(npy("{\"shape\":(1,3,),\"descr\":\"<f8\",\"fortran_order\":False}   ", data), "a").points,
            expected);
}

TEST(Npy, EveryTruncationIsRefused) {
  const std::string bytes = npy_bytes({{1, 2, 3}, {4, 5, 6}}, Precision::kFloat64, "a");
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_THROW((void)parse_npy_points(std::string_view(bytes).substr(0, length), "a"), Error) << length;
  }
}

TEST(Npy, IndicesBeyondInt32AreRefused) {
  std::string data = numbers<std::int64_t>({0, 1});
  append(data, std::int64_t{1} << 31, std::endian::little);
  expect_error(ErrorKind::kBadInput, "face 0 names vertex 2147483648",
               [&] { (void)parse_npy_triangles(npy(dictionary("<i8", "(1, 3)"), data), "a"); });
  data.resize(16);
  append(data, ~std::uint64_t{0}, std::endian::little);
  expect_error(ErrorKind::kBadInput, "face 0 names vertex 18446744073709551615",
               [&] { (void)parse_npy_triangles(npy(dictionary("<u8", "(1, 3)"), data), "a"); });
}

}  // namespace
}  // namespace selvage::io
