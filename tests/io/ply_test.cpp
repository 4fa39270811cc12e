#include <gtest/gtest.h>

#include "io/file/byte_order.h"
#include "io/mesh_reader.h"
#include "tests/io/random_doubles.h"
#include "tests/io/support.h"
#include "tests/property.h"

namespace selvage::io {
namespace {

using testing::check_property;
using testing::expect_error;
using testing::same_bits;

std::string ply(const std::string& format, const std::string& elements, const std::string& data) {
  return "ply\nformat " + format + " 1.0\ncomment made by a test\n" + elements + "end_header\n" + data;
}

const std::string kTriangleElements =
    "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kTriangleData = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

void expect_bad_ply(const std::string& fragment, const std::string& bytes) {
  expect_error(ErrorKind::kBadInput, fragment, [&] { (void)parse_ply(bytes, "a.ply"); });
}

/// A cloud of points and one face in binary, written with the number types named.
template <typename Real, typename Count, typename Index>
std::string binary_ply(const Points& points, std::endian order, const std::string& real, const std::string& count,
                       const std::string& index) {
  std::string data;
  for (const auto& point : points) {
    for (const double x : point) append(data, static_cast<Real>(x), order);
  }
  append(data, Count{3}, order);
  for (const int corner : {2, 0, 1}) append(data, static_cast<Index>(corner), order);
  return ply(order == std::endian::little ? "binary_little_endian" : "binary_big_endian",
             "element vertex " + std::to_string(points.size()) + "\nproperty " + real + " x\nproperty " + real +
                 " y\nproperty " + real + " z\nelement face 1\nproperty list " + count + " " + index +
                 " vertex_indices\n",
             data);
}

TEST(Ply, prop_binary_doubles_come_back_bit_for_bit) {
  check_property(300, 4, [] {
    const Points points = *testing::finite_points();
    RC_PRE(points.size() >= 3);
    const Triangles face = {{2, 0, 1}};
    for (const std::endian order : {std::endian::little, std::endian::big}) {
      const MeshData mesh = parse_ply(
          binary_ply<double, std::uint8_t, std::int32_t>(points, order, "float64", "uint8", "int32"), "a.ply");
      RC_ASSERT(same_bits(mesh.points, points));
      RC_ASSERT(mesh.triangles == face);
      RC_ASSERT(mesh.precision == Precision::kFloat64);
    }
  });
}

TEST(Ply, prop_binary_floats_come_back_exactly) {
  check_property(300, 5, [] {
    Points points = *testing::finite_points();
    RC_PRE(points.size() >= 3);
    for (auto& point : points) {
      for (double& x : point) x = testing::to_lattice(x);
    }
    for (const std::endian order : {std::endian::little, std::endian::big}) {
      const MeshData mesh =
          parse_ply(binary_ply<float, std::uint32_t, std::uint16_t>(points, order, "float", "uint", "ushort"), "a.ply");
      RC_ASSERT(same_bits(mesh.points, points));
      RC_ASSERT(mesh.precision == Precision::kFloat32);
    }
  });
}

TEST(Ply, AllIntegerTypesByBothNames) {
  const auto corners = [](const std::string& count, const std::string& index) {
    return parse_ply(ply("ascii",
                         "element vertex 3\nproperty double x\nproperty double y\nproperty double z\nelement face 1\n"
                         "property list " +
                             count + " " + index + " vertex_index\n",
                         kTriangleData),
                     "a.ply")
        .triangles;
  };
  for (const char* type :
       {"char", "int8", "uchar", "uint8", "short", "int16", "ushort", "uint16", "int", "int32", "uint", "uint32"}) {
    EXPECT_EQ(corners(type, "int"), (Triangles{{0, 1, 2}})) << type;
    EXPECT_EQ(corners("uchar", type), (Triangles{{0, 1, 2}})) << type;
  }
  for (const char* type : {"float", "double", "int64", "long", ""}) {
    EXPECT_THROW(corners(type, "int"), Error) << type;
    EXPECT_THROW(corners("uchar", type), Error) << type;
  }
}

TEST(Ply, TextOfAFloatIsRoundedOnceToFloat) {
  const MeshData mesh = parse_ply(
      ply("ascii", kTriangleElements, "0.1 1.00000017881393432617187499 0\n1 0 0\n0 1 0\n3 0 1 2\n"), "a.ply");
  EXPECT_EQ(mesh.points[0][0], static_cast<double>(0.1f));
  EXPECT_EQ(mesh.points[0][1], 0x1.000002p0) << "through double it would be a tie, and 0x1.000004p0";
  EXPECT_EQ(mesh.precision, Precision::kFloat32);
}

TEST(Ply, OneAxisOfDoublesMakesThemAll) {
  for (const char axis : {'x', 'y', 'z'}) {
    std::string elements = kTriangleElements;
    elements.replace(elements.find(std::string("float ") + axis), 5, "double");
    EXPECT_EQ(parse_ply(ply("ascii", elements, kTriangleData), "a.ply").precision, Precision::kFloat64) << axis;
  }
}

TEST(Ply, OtherPropertiesAndElementsAreSkipped) {
  const std::string elements =
      "obj_info by hand\n"
      "element camera 1\nproperty float f\nproperty list uchar float k\n"
      "element vertex 3\nproperty uchar red\nproperty double z\nproperty double x\nproperty list int int "
      "ring\nproperty double y\n"
      "element face 2\nproperty float quality\nproperty list uchar uint vertex_index\nproperty list uchar float "
      "texcoord\n"
      "element edge 0\nproperty int vertex1\n"
      "element tail 1\nproperty short s\n";
  const Points points = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};
  const Triangles triangles = {{0, 1, 2}, {2, 1, 0}};
  const MeshData text = parse_ply(ply("ascii", elements,
                                      "0.5 2 nan 1\n"
                                      "255 3 1 1 7 2\n\n0 6 4 0 5\n0 9 7 2 1 2 8\n"
                                      "0.25 3 0 1 2 0\n0.25 3 2 1 0 2 inf 1\n-5\n\n \n"),
                                  "a.ply");
  EXPECT_EQ(text.points, points);
  EXPECT_EQ(text.triangles, triangles);

  std::string data;
  const std::endian order = std::endian::big;
  append(data, 0.5f, order);
  append(data, std::uint8_t{2}, order);
  append(data, 1.0f, order);
  append(data, 2.0f, order);
  for (std::size_t i = 0; i < 3; ++i) {
    append(data, std::uint8_t{255}, order);
    append(data, points[i][2], order);
    append(data, points[i][0], order);
    append(data, std::int32_t{static_cast<std::int32_t>(i)}, order);
    for (std::size_t k = 0; k < i; ++k) append(data, std::int32_t{-1}, order);
    append(data, points[i][1], order);
  }
  for (const auto& corners : triangles) {
    append(data, 0.25f, order);
    append(data, std::uint8_t{3}, order);
    for (const std::int32_t corner : corners) append(data, static_cast<std::uint32_t>(corner), order);
    append(data, std::uint8_t{1}, order);
    append(data, 0.0f, order);
  }
  append(data, std::int16_t{-5}, order);
  const MeshData binary = parse_ply(ply("binary_big_endian", elements, data), "a.ply");
  EXPECT_EQ(binary.points, points);
  EXPECT_EQ(binary.triangles, triangles);
  expect_bad_ply("bytes follow the last record", ply("binary_big_endian", elements, data + "x"));
  for (std::size_t length = 0; length < data.size(); ++length) {
    EXPECT_THROW((void)parse_ply(ply("binary_big_endian", elements, data.substr(0, length)), "a.ply"), Error) << length;
  }
}

TEST(Ply, HeaderLinesMayEndInCrLf) {
  std::string bytes = binary_ply<double, std::uint8_t, std::int32_t>({{1, 2, 3}, {4, 5, 6}, {7, 8, 9}},
                                                                     std::endian::little, "double", "uchar", "int");
  for (std::size_t at = 0, end = bytes.find("end_header\n") + 11; (at = bytes.find('\n', at)) < end; at += 2, ++end) {
    bytes.insert(at, "\r");
  }
  EXPECT_EQ(parse_ply(bytes, "a.ply").points[2], (std::array<double, 3>{7, 8, 9}));
}

TEST(Ply, PolygonsAreFans) {
  const MeshData mesh =
      parse_ply(ply("ascii",
                    "element vertex 5\nproperty double x\nproperty double y\nproperty double z\nelement face 1\n"
                    "property list uchar int vertex_indices\n",
                    "0 0 0\n1 0 0\n2 1 0\n1 2 0\n0 1 0\n5 4 3 2 1 0\n"),
                "a.ply");
  EXPECT_EQ(mesh.triangles, (Triangles{{4, 3, 2}, {4, 2, 1}, {4, 1, 0}}));
}

// Fans of polygons whose corners take one byte each are twelve times as long as the file.
TEST(Ply, PolygonsThatBecomeTenTimesTheFileAreRefusedWhereTheyAreMany) {
  const auto polygons = [](int count) {
    std::string data(3 * 255, '\0');
    for (int face = 0; face < count; ++face) {
      data += '\xff';
      for (int corner = 0; corner < 255; ++corner) data += static_cast<char>(corner);
    }
    return ply("binary_little_endian",
               "element vertex 255\nproperty uchar x\nproperty uchar y\nproperty uchar z\nelement face " +
                   std::to_string(count) + "\nproperty list uchar uchar vertex_indices\n",
               data);
  };
  EXPECT_EQ(parse_ply(polygons(200), "a.ply").triangles.size(), 200U * 253);
  expect_bad_ply("the polygons become more than ten times the file; export triangles", polygons(400));
}

TEST(Ply, ALastNumberThatMayBeCutIsRefused) {
  const auto cut = [](const std::string& last_line, int count = 13) {
    std::string points;
    for (int i = 0; i < count; ++i) points += std::to_string(i) + " 0 " + std::to_string(i * i) + "\n";
    return ply("ascii",
               "element vertex " + std::to_string(count) +
                   "\nproperty float x\nproperty float y\nproperty float z\n"
                   "element face 1\nproperty list uchar int vertex_indices\n",
               points + last_line);
  };
  expect_bad_ply("a.ply:24: the last line has no end and its number may be cut", cut("3 3 4 1"));
  EXPECT_EQ(parse_ply(cut("3 3 4 1\n"), "a.ply").triangles, (Triangles{{3, 4, 1}}));
  for (const char* end : {" ", "\r"})
    EXPECT_EQ(parse_ply(cut(std::string("3 3 4 1") + end), "a.ply").triangles[0][2], 1);
  expect_bad_ply("its number may be cut", cut("3 3 4 1", 11));  // of vertex 10, the last there is
  EXPECT_EQ(parse_ply(cut("3 3 4 1", 10), "a.ply").triangles[0][2], 1);
  // No more digits can follow: there is no such vertex.
  for (const int whole : {2, 9, 12, 0}) {
    EXPECT_EQ(parse_ply(cut("3 3 4 " + std::to_string(whole)), "a.ply").triangles[0][2], whole);
  }
  const std::string faces_first =
      "element face 1\nproperty list uchar int vertex_indices\n"
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  expect_bad_ply("its number may be cut", ply("ascii", faces_first, "3 0 1 2\n0 0 0\n1 0 0\n0 1 0.1"));
  EXPECT_EQ(parse_ply(ply("ascii", kTriangleElements + "property float quality\n", "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0.1"),
                      "a.ply")
                .triangles.size(),
            1u)
      << "what is skipped may be cut";
}

TEST(Ply, MalformedHeadersAreNamedByLine) {
  const auto with = [](const std::string& elements) { return ply("ascii", elements, kTriangleData); };
  expect_bad_ply("a.ply:4: 'strange' does not belong here", with("strange\n"));
  expect_bad_ply("a.ply:4: 'property' does not belong here", with("property float x\n"));
  expect_bad_ply("a.ply:4: an element needs a name and a count", with("element vertex -3\n"));
  expect_bad_ply("a.ply:6: two properties are named 'x'", with("element vertex 3\nproperty int x\nproperty float x\n"));
  expect_bad_ply("a second element 'vertex'", with(kTriangleElements + "element vertex 0\nproperty int x\n"));
  expect_bad_ply("no element \"face\"",
                 with("element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"));
  expect_bad_ply("no numbers x, y, z", with("element vertex 1\nproperty float x\nelement face 1\nproperty float y\n"));
  expect_bad_ply("a.ply:8: the faces have both \"vertex_indices\" and \"vertex_index\"; remove one of the two lists",
                 with(kTriangleElements + "property list uchar int vertex_index\n"));
  expect_bad_ply("'tristrips' is not supported",
                 with(kTriangleElements + "element tristrips 1\nproperty list int int vertex_indices\n"));
  expect_bad_ply("a.ply:2: the format is not version 1.0", "ply\nformat ascii 2.0\nend_header\n");
  expect_bad_ply("has no \"format\" line", "ply\nend_header\n");
  expect_bad_ply("an element has no property", with(kTriangleElements + "element odd 0\n"));
}

}  // namespace
}  // namespace selvage::io
