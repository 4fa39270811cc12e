// No parser allocates much more than the file is long, whatever the file says.
#include <numeric>

#include <gtest/gtest.h>

#include "io/error.h"
#include "tests/io/allocations.h"
#include "tests/io/npy_builder.h"
#include "tests/io/parsers.h"
#include "tests/io/point_cache_builder.h"
#include "tests/io/zip_writer.h"

namespace selvage::io {
namespace {

using testing::parser_named;

std::string repeated(const std::string& text, std::size_t size) {
  std::string bytes;
  while (bytes.size() < size) bytes += text;
  return bytes;
}

struct Dense {
  std::string name, parser, bytes;
  std::size_t most = testing::kMostMemory;  ///< bytes of memory a byte of the file
  friend void PrintTo(const Dense& file, std::ostream* out) { *out << file.name; }
};

/// The files that give most data for their bytes.
std::vector<Dense> dense_files() {
  constexpr std::size_t kSize = 1'000'000;
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  std::string fan = "v 0 0 0\nf";
  for (int i = 1; fan.size() < 1'000'000; ++i) fan += " " + std::to_string(i);
  const std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex ";
  const std::string vertex = "\nproperty uchar x\nproperty uchar y\nproperty uchar z\nelement face ";
  const std::string face = "\nproperty list uchar uchar vertex_indices\nend_header\n";
  const std::string faces = repeated({"\3\0\1\2", 4}, kSize);
  std::string alternating;
  for (std::size_t i = 0; i < 200'000; ++i) alternating += static_cast<char>(i % 2);
  const std::string triangles = repeated({"\0\1\2", 3}, 600'000);
  std::vector<float> many_times(20'000);
  std::iota(many_times.begin(), many_times.end(), 0.0f);
  const auto array = [](const std::string& descr, const std::string& shape, const std::string& data) {
    return testing::npy(testing::dictionary(descr, shape), data);
  };
  return {
      {"obj_vertices", "obj", repeated("v 0 0 0\n", kSize) + "f 1 2 3\n"},
      {"obj_faces", "obj", obj + repeated("f 1 2 3\n", kSize)},
      {"obj_groups", "obj", obj + repeated("g\nf 1 2 3\n", kSize)},
      {"obj_fan", "obj", fan},
      {"ply_vertices", "ply", header + "333333" + vertex + "0" + face + std::string(3 * 333333, '\0')},
      {"ply_faces", "ply",
       header + "3" + vertex + std::to_string(faces.size() / 4) + face + std::string(9, '\0') + faces},
      {"ply_liar", "ply", header + "2147483647" + vertex + "2147483647" + face + std::string(kSize, '\0')},
      {"npy_bytes", "npy_triangles", array("|u1", "(200000, 3)", triangles)},
      {"npy_liar", "npy_points", array("<f8", "(1000000000000, 3)", std::string(kSize, '\0'))},
      {"npy_integers", "npy_integers", array("|i1", "(1000000,)", std::string(kSize, '\0'))},
      {"npz_groups", "npz",
       testing::zip({{.name = "V.npy", .content = array("<f4", "(3, 3)", std::string(36, '\0'))},
                     {.name = "F.npy", .content = array("|u1", "(200000, 3)", triangles)},
                     {.name = "group.npy", .content = array("|u1", "(200000,)", alternating)}})},
      {"npz_bomb", "npz",
       testing::zip({{.name = "V.npy",
                      .content = std::string(50'000'000, '\0'),
                      .deflate = true,
                      .size_error = 1000 - 50'000'000}})},
      {"npz_members", "npz", testing::zip(std::vector<testing::ZipEntry>(20'000))},
      {"pc2", "pc2", testing::pc2(4, 20'000)},
      {"pc2_liar", "pc2", testing::pc2(4, 20'000, 0x7fffffff)},
      {"mdd", "mdd", testing::mdd(4, many_times)},
      {"mdd_liar", "mdd", testing::mdd(4, many_times, 0x7fffffff)},
      {"query_csv", "query_csv", repeated("1,1,1,1,1,1\n", 12 * 8 * 20'000)},
      {"sequence_json", "sequence_json", "[" + repeated("0,", 1'000'000) + "0]",
       18},  // the tree of JSON values; of a file of at most 1 MiB
      {"frame_list", "frame_list", repeated("{\"file\":\"a\"}\n", kSize)},
      {"frame_list_line", "frame_list", repeated("[", kSize)},
  };
}

class Memory : public ::testing::TestWithParam<Dense> {};

TEST_P(Memory, IsBoundedByTheFile) {
  const Dense& file = GetParam();
  const std::size_t used = testing::peak_during([&] {
    try {
      parser_named(file.parser).parse(file.bytes);
    } catch (const Error&) {
      // refused files are bounded too
    }
  });
  RecordProperty("peak_per_byte", std::to_string(static_cast<double>(used) / static_cast<double>(file.bytes.size())));
  EXPECT_LE(used, file.most * file.bytes.size() + testing::kMemoryConstant)
      << used / file.bytes.size() << " times the file";
}

INSTANTIATE_TEST_SUITE_P(All, Memory, ::testing::ValuesIn(dense_files()), [](const auto& of) { return of.param.name; });

}  // namespace
}  // namespace selvage::io
