// What is read and written does not depend on the caller's floating-point environment.
#include <bit>
#include <cfenv>
#include <cstring>
#include <functional>

#include <gtest/gtest.h>

#include "io/error.h"
#include "io/format/npy.h"
#include "io/mesh_reader.h"
#include "io/points.h"
#include "io/query_csv.h"
#include "io/sequence/sequence_json.h"
#include "io/sequence/sequence_outputs.h"
#include "io/sequence/sequence_readers.h"
#include "tests/fp_control.h"
#include "tests/io/npy_builder.h"
#include "tests/io/point_cache_builder.h"
#include "tests/io/zip_writer.h"

namespace selvage::io {
namespace {

std::string bits(const Points& points) {
  return {reinterpret_cast<const char*>(points.data()), points.size() * sizeof(points[0])};
}

/// Subnormal numbers, the smallest, halves of an ulp, and what no rounding but the nearest gets right.
const std::string kNumbers[] = {"4.9406564584124654e-324",
                                "1e-310",
                                "2.2250738585072011e-308",
                                "0.1",
                                "9007199254740993",
                                "1e23",
                                "8.41e+210",
                                "1.4012984643248171e-45",
                                "-0.30000000000000004"};
const float kSubnormal = std::bit_cast<float>(1u), kTiny = std::bit_cast<float>(0x007fffffu);

std::string vertices(const std::string& before) {
  std::string text;
  for (const std::string& number : kNumbers)
    text += before + number + " " + number + " -" + (number[0] == '-' ? number.substr(1) : number) + "\n";
  return text;
}

std::string with_subnormals(std::string bytes, std::size_t header, std::endian order) {
  std::string numbers;
  for (const float x : {kSubnormal, kTiny, -kSubnormal}) testing::append_bytes(numbers, x, order == std::endian::big);
  return bytes.replace(header, numbers.size(), numbers);
}

std::string read_cache(const std::string& bytes, PointCacheFormat format) {
  MeshData base;
  base.points.resize(4);
  base.triangles = {{0, 1, 2}, {2, 1, 3}};
  const auto reader = open_point_cache(in_memory(bytes), format, base, "in");
  std::string all;
  for (std::size_t i = 0; i < reader->frame_count(); ++i)
    all += bits(reader->frame(i).points) + bits({{reader->time(i)}});
  return all;
}

struct Reading {
  std::string name;
  std::function<std::string()> bytes;  ///< of all numbers that were read, or of what was written
};

std::vector<Reading> readings() {
  const std::string ply =
      "element vertex 9\nproperty double x\nproperty double y\nproperty double z\nelement face 0\n"
      "property list uchar int vertex_indices\nend_header\n";
  const std::string binary_ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 0\nproperty list uchar int vertex_indices\nend_header\n";
  std::string floats;
  for (const float x : {kSubnormal, kTiny, -kTiny}) testing::append_bytes(floats, x, false);
  const std::string npy = testing::npy(testing::dictionary("<f4", "(1, 3)"), floats);
  // Made here, where numbers are as they should be.
  const std::string pc2 = with_subnormals(testing::pc2(4, 2, {}, 0.1f, 0.1f), 32, std::endian::little);
  const std::string mdd = with_subnormals(testing::mdd(4, {0.1f, 0.2f}), 16, std::endian::big);
  std::string queries;
  for (int row = 0; row < 8; ++row) queries += "6004799503160661,36028797018963968,-3,4,1,1" + std::string(",0\n");
  return {
      {"obj", [] { return bits(parse_obj(vertices("v ") + "f 1 2 3\n", "in").points); }},
      {"ply", [=] { return bits(parse_ply("ply\nformat ascii 1.0\n" + ply + vertices(""), "in").points); }},
      {"binary_ply", [=] { return bits(parse_ply(binary_ply + floats, "in").points); }},
      {"npy", [=] { return bits(parse_npy_points(npy, "in").points); }},
      {"npz",
       [=] {
         const std::string faces =
             testing::npy(testing::dictionary("<i4", "(1, 3)"), testing::numbers<std::int32_t>({0, 1, 2}));
         const std::string three = testing::npy(testing::dictionary("<f4", "(3, 3)"), floats + floats + floats);
         const std::string zip =
             testing::zip({{.name = "V.npy", .content = three}, {.name = "F.npy", .content = faces}});
         return bits(open_npz_sequence(in_memory(zip), "in")->frame(0).points);
       }},
      {"pc2", [=] { return read_cache(pc2, PointCacheFormat::kPc2); }},
      {"mdd", [=] { return read_cache(mdd, PointCacheFormat::kMdd); }},
      {"query_csv",
       [=] {
         const CcdQuery query = parse_query_csv(queries, "in").at(0);
         return bits({query.points.begin(), query.points.end()});
       }},
      {"frame_list",
       [] {
         std::string all;
         for (const FrameRecord& frame :
              parse_frame_list(to_json(FrameRecord{"a", 1e-310, 7}) + to_json(FrameRecord{"b", 0.1, {}}), "in")) {
           all += bits({{frame.time_s}});
         }
         return all;
       }},
      {"obj_bytes",
       [] {
         MeshData mesh;
         mesh.points = {{0x1p-1074, 1e-310, 0.1}, {1e23, 8.41e210, -0x1p-149}};
         return obj_bytes(mesh, "in");
       }},
      {"to_float32",
       [] {
         Points points = {{0.1, 0x1p-149, 1e-40}, {1.0 / 3, -0.7, 0x1.8p-149}};
         Rounding rounding;
         round_to_float32(points, rounding, "in");
         std::string bytes = bits(points) + bits({{rounding.largest_change}});
         append_points(bytes, points, Precision::kFloat32, "in");
         return bytes + to_json(FrameRecord{"a", 1e-310, 7});
       }},
  };
}

class FpEnvironment : public ::testing::TestWithParam<std::size_t> {};

TEST_P(FpEnvironment, ChangesNothingThatIsReadOrWritten) {
  const Reading reading = readings()[GetParam()];
  const std::string expected = reading.bytes();
  for (const int rounding : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
    ASSERT_EQ(std::fesetround(rounding), 0);
    const std::string read = reading.bytes();
    const int after = std::fegetround();
    std::fesetround(FE_TONEAREST);
    EXPECT_EQ(after, rounding) << "the caller's mode is kept";
    EXPECT_TRUE(read == expected) << "rounding mode " << rounding;
  }
  const unsigned found = testing::fp_control();
  testing::set_fp_control(found | testing::kFlushing);  // as a library built with -ffast-math leaves it
  const std::string read = reading.bytes();
  testing::set_fp_control(found);
  EXPECT_TRUE(read == expected) << "subnormal numbers flushed";
}

INSTANTIATE_TEST_SUITE_P(All, FpEnvironment, ::testing::Range(std::size_t{0}, readings().size()),
                         [](const auto& of) { return readings()[of.param].name; });

}  // namespace
}  // namespace selvage::io
