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

constexpr std::size_t kSize = 1'000'000;

/// kSize bytes of `text`, or a few more.
std::string filled_with(const std::string& text) {
  std::string bytes;
  while (bytes.size() < kSize) bytes += text;
  return bytes;
}

/// What grows by doubling takes most where there is one more than a power of two.
constexpr int kUnlucky = (1 << 16) + 1;

std::string repeated(const std::string& text, int count) {
  std::string bytes;
  for (int i = 0; i < count; ++i) bytes += text;
  return bytes;
}

/// " 1 2 ... N"
std::string numbers_up_to(int count) {
  std::string text;
  for (int i = 1; i <= count; ++i) text += " " + std::to_string(i);
  return text;
}

/// A PLY file whose faces are lists of `list`: `vertices` of three bytes, and `faces` records of `face`.
std::string ply_of(int vertices, const std::string& list, int faces, const std::string& face) {
  return "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(vertices) +
         "\nproperty uchar x\nproperty uchar y\nproperty uchar z\nelement face " + std::to_string(faces) +
         "\nproperty list " + list + " vertex_indices\nend_header\n" +
         std::string(3 * static_cast<std::size_t>(vertices), '\0') + repeated(face, faces);
}

struct Dense {
  std::string name, parser, bytes;
  friend void PrintTo(const Dense& file, std::ostream* out) { *out << file.name; }
};

/// The files that give most data for their bytes.
std::vector<Dense> dense_files() {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  std::string fan = "v 0 0 0\nf";
  for (int i = 1; fan.size() < 1'000'000; ++i) fan += " " + std::to_string(i);
  std::string obj_statement = "v 0 0 0\nf";
  for (int i = 0; i < 100'000; ++i) obj_statement += " 1 1\\\n1 1 1";
  std::string liar = ply_of(0, "uchar uchar", 0, "");
  for (const std::string element : {"vertex ", "face "}) liar.insert(liar.find(element) + element.size(), "214748364");
  std::string polygon = {'\xff'};
  for (int i = 0; i < 255; ++i) polygon += static_cast<char>(i);
  std::string short_polygon = {'\7'};
  for (int i = 0; i < 7; ++i) short_polygon += static_cast<char>(i);
  std::string alternating;
  for (std::size_t i = 0; i < 200'000; ++i) alternating += static_cast<char>(i % 2);
  const std::string triangles = repeated({"\0\1\2", 3}, 200'000);
  std::vector<float> many_times(20'000);
  std::iota(many_times.begin(), many_times.end(), 0.0f);
  const auto array = [](const std::string& descr, const std::string& shape, const std::string& data) {
    return testing::npy(testing::dictionary(descr, shape), data);
  };
  return {
      {"obj_vertices", "obj", filled_with("v 0 0 0\n") + "f 1 2 3\n"},
      {"obj_faces", "obj", obj + filled_with("f 1 2 3\n")},
      {"obj_groups", "obj", obj + filled_with("g\nf 1 2 3\n")},
      {"obj_fan", "obj", fan},
      {"obj_indented_vertices", "obj", repeated(" v 0 0 0\n", kUnlucky) + "f 1 2 3\n"},
      {"obj_indented_groups", "obj", obj + repeated(" g\nf 1 2 3\n", kUnlucky)},
      {"obj_polygons", "obj", repeated("v 0 0 0\n", 19) + repeated("f" + numbers_up_to(19) + "\n", 16 * 1024)},
      {"obj_polygons_in_two_lines", "obj",
       repeated("v 0 0 0\n", 19) + repeated("f \\\n" + numbers_up_to(19) + "\n", 16 * 1024)},
      {"obj_repeated_corner", "obj", "v 0 0 0\nf" + repeated(" 1", 4 * kUnlucky)},
      {"obj_repeated_corner_in_many_lines", "obj", obj_statement},
      {"ply_vertices", "ply", ply_of(333'333, "uchar uchar", 0, "")},
      {"ply_faces", "ply", ply_of(3, "uchar uchar", 4 * kUnlucky, {"\3\0\1\2", 4})},
      {"ply_polygons", "ply", ply_of(7, "uchar uchar", 13'108, short_polygon)},
      {"ply_largest_polygons", "ply", ply_of(255, "uchar uchar", 4'000, polygon)},
      {"ply_repeated_corner", "ply",
       ply_of(300'000, "uint uchar", 1, std::string("\x40\x42\x0f\0", 4) + std::string(1'000'000, '\0'))},
      {"ply_repeated_corner_text", "ply",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty uchar x\nproperty uchar y\nproperty uchar z\n"
       "element face 1\nproperty list uint uchar vertex_indices\nend_header\n0 0 0\n0 0 0\n0 0 0\n500000" +
           repeated(" 0", 500'000)},
      {"ply_liar", "ply", liar + std::string(kSize, '\0')},
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
      {"query_csv", "query_csv", repeated("1,1,1,1,1,1\n", 8 * 20'000)},
      {"json_list", "sequence_json", "[" + filled_with("0,") + "0]"},
      {"json_text", "sequence_json", R"({"producer":")" + filled_with("a") + "\"}"},
      {"json_open_text", "sequence_json", R"({"producer":")" + filled_with("a")},
      {"json_groups", "sequence_json",
       R"({"groups":[)" + repeated(R"({"name":"","role":"body","faces":[0,0]},)", 16 * 1024 + 1)},
      {"json_group_names", "sequence_json",
       R"({"groups":[)" + repeated(R"({"name":"sixteen letters!","role":"body","faces":[0,0]},)", 16 * 1024 + 1)},
      {"json_range", "sequence_json", R"({"groups":[{"faces":[)" + filled_with("0,")},
      {"json_keys", "sequence_json", "{" + filled_with(R"("note":"",)")},
      {"json_deep", "sequence_json", filled_with(R"({"faces":)")},
      {"frame_list", "frame_list", repeated("{\"file\":\"a\"}\n", kUnlucky)},
      {"frame_list_line", "frame_list", filled_with("[")},
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
  EXPECT_LE(used, testing::kMaxMemory * file.bytes.size() + testing::kMemoryConstant)
      << used / file.bytes.size() << " times the file";
}

INSTANTIATE_TEST_SUITE_P(All, Memory, ::testing::ValuesIn(dense_files()), [](const auto& of) { return of.param.name; });

}  // namespace
}  // namespace selvage::io
