// Files made to break a parser. Each is refused in one line that says where and what.
#include <gtest/gtest.h>

#include "io/sequence.h"
#include "io/sequence/sequence_json.h"
#include "tests/io/npy_builder.h"
#include "tests/io/parsers.h"
#include "tests/io/point_cache_builder.h"
#include "tests/io/support.h"

namespace selvage::io {
namespace {

using testing::dictionary;
using testing::expect_error;
using testing::npy;
using testing::numbers;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;

struct Hostile {
  std::string name, parser, bytes, fragment;

  friend void PrintTo(const Hostile& file, std::ostream* out) { *out << file.parser; }
};

const std::string kThreeVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list char int vertex_indices\nend_header\n";

std::string ply_with(const std::string& from, const std::string& to) {
  std::string header = kPly;
  return header.replace(header.find(from), from.size(), to);
}

std::string sequence_json(const std::string& from, const std::string& to) {
  std::string text =
      to_json(SequenceDescription{"test", SequenceKind::kSteps, Precision::kFloat64, {}, "faces.npy", 7});
  return text.replace(text.find(from), from.size(), to);
}

std::string rows(int count, const std::string& row) {
  std::string text;
  for (int i = 0; i < count; ++i) text += row + "\n";
  return text;
}

std::vector<Hostile> hostile_files() {
  const std::string ply_data = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const std::string three = numbers<double>({1, 2, 3});
  const std::string longest(2'000'000, '1');
  return {
      // OBJ
      {"obj_empty", "obj", "", "in: no vertex"},
      {"obj_only_vertices", "obj", kThreeVertices, "in: no face"},
      {"obj_binary", "obj",
       std::string("\x7f"
                   "ELF\0\1\2",
                   7),
       "in:1: '?ELF"},
      {"obj_zero_index", "obj", kThreeVertices + "f 0 1 2\n", "in:4: vertex '0' of 3"},
      {"obj_index_beyond", "obj", kThreeVertices + "f 1 2 3\nf 1 2 4\n", "in:5: vertex 4 of 3"},
      {"obj_negative_beyond", "obj", kThreeVertices + "f -1 -2 -4\n", "in:4: vertex '-4' of 3"},
      {"obj_index_overflow", "obj", kThreeVertices + "f 1 2 4294967297\n", "in:4: vertex '4294967297' of 3"},
      {"obj_two_corners", "obj", kThreeVertices + "f 1 2\n", "in:4: a face has 2 corners"},
      {"obj_no_corner", "obj", kThreeVertices + "f\n", "in:4: a face has 0 corners"},
      {"obj_repeated_corner", "obj", kThreeVertices + "f 1 2 3 1\n", "in:4: a face names the same vertex twice"},
      {"obj_repeated_by_negative", "obj", kThreeVertices + "f 1 2 -2\n", "in:4: a face names the same vertex twice"},
      {"obj_nan", "obj", kThreeVertices + "v 0 nan 0\nf 1 2 3\n", "in:4: 'nan' is not finite"},
      {"obj_infinity", "obj", "v 0 -inf 0\n" + kThreeVertices, "in:1: '-inf' is not finite"},
      {"obj_overflow", "obj", kThreeVertices + "\nv 1e999 0 0\n", "in:5: '1e999' is outside the range"},
      {"obj_underflow", "obj", kThreeVertices + "v 1e-999 0 0\n", "in:4: '1e-999' is outside the range"},
      {"obj_decimal_comma", "obj", "v 0,5 1 2\n", "in:1: '0,5' is not a decimal number"},
      {"obj_hexadecimal", "obj", "v 0x1p3 1 2\n", "in:1: '0x1p3' is not a decimal number"},
      {"obj_two_numbers", "obj", "v 0 1\n", "in:1: a vertex has 2 numbers"},
      {"obj_seven_numbers", "obj", "v 0 1 2 3 4 5 6\n", "in:1: a vertex has more than six"},
      {"obj_rational_weight", "obj", "v 0 1 2 0.5\n", "in:1: a vertex has 4 numbers"},
      {"obj_name_not_utf8", "obj", kThreeVertices + "g caf\xe9\nf 1 2 3\n", "in:4: the name is not UTF-8"},
      {"obj_name_overlong_utf8", "obj", kThreeVertices + "g \xc0\xaf\nf 1 2 3\n", "in:4: the name is not UTF-8"},
      {"obj_keyword_not_utf8", "obj", kThreeVertices + "\xff\xfe 1 2 3\n", "in:4: "},
      {"obj_nul", "obj", kThreeVertices + std::string("f 1 2 3\0 4\n", 11), "in:4: '3?' is not v"},
      {"obj_huge_line", "obj", kThreeVertices + "f " + longest, "in:4: line longer than 1048576"},
      {"obj_huge_statement", "obj", "v" + rows(200'000, " 000 \\"), "statement longer than a line"},
      {"obj_open_continuation", "obj", kThreeVertices + "f 1 2 \\", "in:4: the file ends behind a backslash"},
      {"obj_lines", "obj", kThreeVertices + "f 1 2 3\nl 1 2\n", "in:5: 'l' is not part of a surface"},
      {"obj_cr_in_comment", "obj", kThreeVertices + "# a\rf 1 2 3\n" + "f 1 2 3\n", "in:4: a CR without LF"},
      {"obj_cr_in_skipped", "obj", kThreeVertices + "usemtl a\rf 1 2 3\r\n" + "f 1 2 3\n", "in:4: a CR without LF"},
      {"obj_cr_alone", "obj", "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3\r", "in:1: a CR without LF"},
      {"obj_cr_twice", "obj", "v 0 0 0\r\r\n", "in:1: a CR without LF"},
      {"obj_cr_alone_long", "obj", "v " + std::string(2'000'000, '\r'), "in:1: a CR without LF"},
      {"obj_line_break_in_token", "obj", "v 1\v2 3 4\n", "in:1: '1?2' is not a decimal number"},
      // PLY
      {"ply_empty", "ply", "", "in:1: the first line is not \"ply\""},
      {"ply_cr_alone", "ply", "ply\rformat ascii 1.0\r", "in:1: a CR without LF"},
      {"ply_truncated_header", "ply", kPly.substr(0, 55), "the header has no \"end_header\""},
      {"ply_count_4e9", "ply", ply_with("vertex 3", "vertex 4000000000") + "0123456789", "in:3: more than 2^31"},
      {"ply_count_2e9", "ply", ply_with("vertex 3", "vertex 2000000000") + "0123456789",
       "in:3: 2000000000 of 'vertex' do not fit in the 10 bytes left"},
      {"ply_faces_2e9", "ply", ply_with("face 1", "face 2000000000") + ply_data,
       "in:7: 2000000000 of 'face' do not fit"},
      {"ply_negative_count", "ply", ply_with("vertex 3", "vertex -3") + ply_data,
       "in:3: an element needs a name and a count"},
      {"ply_unknown_type", "ply", ply_with("float y", "quad y") + ply_data, "in:5: 'quad' is not a PLY type"},
      {"ply_float_list_count", "ply", ply_with("list char", "list float") + ply_data,
       "in:8: the count of a list is not"},
      {"ply_list_for_x", "ply", ply_with("float x", "list char int x") + ply_data,
       "in:3: the vertices have no numbers x, y, z"},
      {"ply_float_indices", "ply", ply_with("char int", "char float") + ply_data,
       "in:7: the faces have no list of integers"},
      {"ply_unknown_format", "ply", ply_with("ascii", "binary_middle_endian") + ply_data,
       "in:2: 'binary_middle_endian' is not"},
      {"ply_negative_list", "ply", kPly + "0 0 0\n1 0 0\n0 1 0\n-3 0 1 2\n",
       "in:13: a face has a negative number of corners"},
      {"ply_list_too_long", "ply", kPly + "0 0 0\n1 0 0\n0 1 0\n4 0 1 2\n", "in:13: the record has fewer values"},
      {"ply_list_too_short", "ply", kPly + "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 0\n", "in:13: the record has more values"},
      {"ply_count_not_char", "ply", kPly + "0 0 0\n1 0 0\n0 1 0\n128 0 1 2\n",
       "in:13: '128' is no integer of its type"},
      {"ply_index_beyond", "ply", kPly + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "in:13: vertex 3 of 3"},
      {"ply_index_negative", "ply", kPly + "0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "in:13: vertex -1 of 3"},
      {"ply_repeated_corner", "ply", kPly + "0 0 0\n1 0 0\n0 1 0\n3 0 1 1\n",
       "in:13: a face names the same vertex twice"},
      {"ply_more_corners_than_vertices", "ply", kPly + "0 0 0\n1 0 0\n0 1 0\n4 0 1 2 0\n",
       "in:13: a face has 4 corners, its indices can name 3 vertices"},
      {"ply_two_corners", "ply", kPly + "0 0 0\n1 0 0\n0 1 0\n2 0 1\n", "in:13: a face has 2 corners"},
      {"ply_record_short", "ply", kPly + "0 0 0\n1 0\n0 1 0\n3 0 1 2\n", "in:11: the record has fewer values"},
      {"ply_record_missing", "ply", kPly + "0 0 0\n1 0 0.00000000000\n0 1 0\n", "in:12: records are missing"},
      {"ply_record_extra", "ply", kPly + ply_data + "3 0 1 2\n", "in:14: more records than the header"},
      {"ply_nan", "ply", kPly + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", "in:11: 'nan' is not finite"},
      {"ply_beyond_float", "ply", kPly + "0 0 0\n1 1e39 0\n0 1 0\n3 0 1 2\n", "in:11: '1e39' is outside the range"},
      {"ply_binary_nan", "ply",
       ply_with("ascii", "binary_little_endian") + std::string(20, '\0') + "\0\0\xc0\x7f" + std::string(30, '\0'),
       "byte "},
      {"ply_binary_trailing", "ply",
       ply_with("ascii", "binary_big_endian") + std::string(36, '\0') + std::string("\3\0\0\0\0\0\0\0\1\0\0\0\2", 13) +
           "x",
       "bytes follow the last record"},
      {"ply_binary_list_beyond", "ply",
       ply_with("ascii", "binary_big_endian") + std::string(36, '\0') + std::string("\x7f\0\0\0\0\0\0\0\1\0\0\0\2", 13),
       "a face has fewer corners than it announces"},
      {"ply_binary_negative_list", "ply",
       ply_with("ascii", "binary_big_endian") + std::string(36, '\0') + std::string("\xff\0\0\0\0\0\0\0\1\0\0\0\2", 13),
       "negative number of corners"},
      {"ply_skipped_list_2e9", "ply",
       "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
       "property list uint double more\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n" +
           std::string(12, '\0') + "\xff\xff\xff\xff",
       "records are missing"},
      // NPY
      {"npy_empty", "npy_points", "", "no .npy magic"},
      {"npy_magic", "npy_points", "\x93NUMPZ" + three, "no .npy magic"},
      {"npy_version", "npy_points", npy(dictionary("<f8", "(1, 3)"), three, 9), "version 9 is not known"},
      {"npy_header_cut", "npy_points", npy(dictionary("<f8", "(1, 3)"), "").substr(0, 40), "header is cut short"},
      {"npy_header_huge", "npy_points", npy(dictionary("<f8", "(1, 3)") + std::string(5000, ' '), three),
       "longer than 4096"},
      {"npy_shape", "npy_points", npy(dictionary("<f8", "(3,)"), three), "the shape is 3, not n by 3"},
      {"npy_shape_scalar", "npy_points", npy(dictionary("<f8", "()"), numbers<double>({1})),
       "the shape is a single number"},
      {"npy_shape_columns", "npy_points", npy(dictionary("<f8", "(3, 1)"), three), "the shape is 3 by 1"},
      {"npy_shape_overflow", "npy_points", npy(dictionary("<f8", "(4611686018427387904, 3)"), three),
       "larger than any file"},
      {"npy_shape_wraps", "npy_points", npy(dictionary("<f8", "(768614336404564651, 3)"), three),
       "larger than any file"},
      {"npy_shape_huge", "npy_points", npy(dictionary("<f8", "(100000000000, 3)"), three),
       "announces 2400000000000 bytes of data, 24 follow"},
      {"npy_shape_negative", "npy_points", npy(dictionary("<f8", "(-1, 3)"), three), "header is malformed"},
      {"npy_shape_dimensions", "npy_points", npy(dictionary("<f8", "(" + rows(9, "1,") + ")"), three),
       "header is malformed"},
      {"npy_trailing", "npy_points", npy(dictionary("<f8", "(1, 3)"), three + "x"),
       "announces 24 bytes of data, 25 follow"},
      {"npy_half", "npy_points", npy(dictionary("<f2", "(1, 3)"), "123456"), "type '<f2' is not supported"},
      {"npy_object", "npy_points", npy(dictionary("|O", "(1, 3)"), three), "type '|O' is not supported"},
      {"npy_native_order", "npy_points", npy(dictionary("=f8", "(1, 3)"), three), "type '=f8' is not supported"},
      {"npy_record", "npy_points", npy("{'descr': [('x', '<f8')], 'fortran_order': False, 'shape': (3,), }", three),
       "type 'a record' is not supported"},
      {"npy_code", "npy_points", npy("__import__('os').system('true')", three), "header is malformed"},
      {"npy_duplicate_key", "npy_points",
       npy("{'descr': '<f8', 'shape': (1, 3), 'shape': (1, 3), 'fortran_order': False}", three), "header is malformed"},
      {"npy_missing_key", "npy_points", npy("{'descr': '<f8', 'shape': (1, 3)}", three), "header is malformed"},
      {"npy_integer_positions", "npy_points", npy(dictionary("<i8", "(1, 3)"), three), "positions are integers"},
      {"npy_nan", "npy_points",
       npy(dictionary("<f8", "(1, 3)"), three.substr(0, 16) + std::string("\0\0\0\0\0\0\xf8\x7f", 8)),
       "vertex 0 is not finite"},
      {"npy_float_faces", "npy_triangles", npy(dictionary("<f8", "(1, 3)"), three), "faces are not integers"},
      {"npy_negative_face", "npy_triangles", npy(dictionary("<i4", "(1, 3)"), numbers<std::int32_t>({0, 1, -1})),
       "face 0 names vertex -1"},
      {"npy_repeated_corner", "npy_triangles",
       npy(dictionary("<i4", "(2, 3)"), numbers<std::int32_t>({0, 1, 2, 3, 1, 3})),
       "face 1 names the same vertex twice"},
      // CSV
      {"csv_empty", "query_csv", "", "in: no query"},
      {"csv_five_columns", "query_csv", rows(8, "1,1,1,1,1"), "in:1: a row has three rationals"},
      {"csv_eight_columns", "query_csv", rows(8, "1,1,1,1,1,1,0,0"), "in:1: a row has three rationals"},
      {"csv_zero_denominator", "query_csv", rows(2, "1,1,1,1,1,1") + rows(6, "1,1,1,0,1,1"),
       "in:3: '1' / '0' has the denominator zero"},
      {"csv_negative_denominator", "query_csv", rows(8, "1,1,1,-2,1,1"), "in:1: '1' / '-2' is no integer over"},
      {"csv_third", "query_csv", rows(8, "1,1,1,3,1,1"), "in:1: '1' / '3' is not exactly a double"},
      {"csv_54_bits", "query_csv", rows(8, "9007199254740993,1,1,1,1,1"),
       "in:1: '9007199254740993' / '1' is not exactly a double"},
      {"csv_too_large", "query_csv", rows(8, "1" + std::string(309, '0') + ",1,1,1,1,1"),
       "in:1: '1000000000000000000000000000000000000000...' / '1' is not exactly"},
      {"csv_too_many_digits", "query_csv", rows(8, std::string(3000, '0') + "1,1,1,1,1,1"), "more than 2048 digits"},
      {"csv_decimal", "query_csv", rows(8, "0.5,1,1,1,1,1"), "in:1: '0.5' / '1' is no integer over"},
      {"csv_incomplete", "query_csv", rows(15, "1,1,1,1,1,1"), "in:15: the last query has 7 of its 8 rows"},
      {"csv_truth", "query_csv", rows(8, "1,1,1,1,1,1,yes"), "in:1: the truth is 'yes'"},
      {"csv_cr_alone", "query_csv", "1,1,1,1,1,1\r1,1,1,1,1,1\r", "in:1: a CR without LF"},
      {"csv_huge_line", "query_csv", longest, "in:1: line longer than"},
      // sequence.json and frames.jsonl
      {"json_empty", "sequence_json", "", "in:1: not valid JSON"},
      {"json_syntax", "sequence_json", sequence_json("\"producer\": \"test\",", "\"producer\": \"test\""),
       "in:4: not valid JSON"},
      {"json_deep", "sequence_json", std::string(100'000, '['), "in: not a JSON object"},
      {"json_deep_object", "sequence_json", rows(1000, "{\"faces\":"), "in: unknown key 'faces'; remove it"},
      {"json_deep_list", "sequence_json", "{\"groups\":" + std::string(1000, '['), "in: not a JSON object"},
      {"json_large", "sequence_json", "[" + std::string(20'000'000, ' ') + "]", "larger than a header"},
      {"json_not_utf8", "sequence_json", sequence_json("test", "\xff"), "in:3: not valid JSON"},
      {"json_number_range", "sequence_json", sequence_json("\"test\"", "1e999"), "number"},
      {"json_zero_behind", "sequence_json", sequence_json("test", "test") + '\0' + "junk", "a zero byte"},
      {"json_other_schema", "sequence_json", sequence_json("sequence/1", "sequence/2"),
       "in: the schema is not selvage.sequence/1"},
      {"json_unknown_key", "sequence_json", sequence_json("\"kind\"", "\"kinds\""), "in: unknown key 'kinds'"},
      {"json_path_for_key", "sequence_json", sequence_json("\"note\"", "\"faces.crc32\""),
       "in: unknown key 'faces.crc32'; remove it"},
      {"json_key_twice", "sequence_json", sequence_json("\"kind\"", "\"note\":\"\",\"kind\""),
       "in: the key 'note' is there twice; remove one"},
      {"json_missing_faces", "sequence_json", R"({"schema":"selvage.sequence/1"})",
       "in: the key 'producer' is missing"},
      {"json_text_for_list", "sequence_json", sequence_json("[]", "\"none\""), "in: \"groups\" is not a list"},
      {"json_list_for_text", "sequence_json", sequence_json("\"test\"", "[]"), "in: 'producer' is not a text"},
      {"json_null_for_text", "sequence_json", sequence_json("\"test\"", "null"), "in: 'producer' is not a text"},
      {"json_text_for_object", "sequence_json", sequence_json("[]", "[\"a\"]"), "in: not a JSON object"},
      {"json_missing_key", "sequence_json", sequence_json("\"kind\": \"steps\",", ""), "in: the key 'kind' is missing"},
      {"json_unknown_kind", "sequence_json", sequence_json("steps", "stops"),
       "in: 'kind' is 'stops'; write frames or steps"},
      {"json_traversal", "sequence_json", sequence_json("faces.npy", "../faces.npy"),
       "in: '../faces.npy' is not the name of a file in the folder"},
      {"json_absolute", "sequence_json", sequence_json("faces.npy", "/etc/passwd"),
       "is not the name of a file in the folder"},
      {"json_nul_in_name", "sequence_json", sequence_json("faces.npy", "a\\u0000b"),
       "is not the name of a file in the folder"},
      {"json_group_reversed", "sequence_json",
       sequence_json("[]", "[{\"name\":\"a\",\"role\":\"cloth\",\"faces\":[5,4]}]"), "ends before it begins"},
      {"json_group_negative", "sequence_json",
       sequence_json("[]", "[{\"name\":\"a\",\"role\":\"cloth\",\"faces\":[-1,4]}]"), "not of face numbers"},
      {"json_group_overflow", "sequence_json",
       sequence_json("[]", "[{\"name\":\"a\",\"role\":\"cloth\",\"faces\":[0,4294967296]}]"), "not of face numbers"},
      {"json_group_fraction", "sequence_json",
       sequence_json("[]", "[{\"name\":\"a\",\"role\":\"cloth\",\"faces\":[0,1.5]}]"), "not of face numbers"},
      {"json_group_range_short", "sequence_json", sequence_json("[]", R"([{"name":"a","role":"cloth","faces":[0]}])"),
       "\"faces\" of a group is not [begin, end]"},
      {"json_group_range_long", "sequence_json",
       sequence_json("[]", R"([{"name":"a","role":"cloth","faces":[0,1,2]}])"), "\"faces\" of a group is not [begin"},
      {"json_group_range_text", "sequence_json",
       sequence_json("[]", R"([{"name":"a","role":"cloth","faces":[0,"1"]}])"), "not of face numbers"},
      {"json_group_second_without_name", "sequence_json",
       sequence_json("[]", R"([{"name":"a","role":"cloth","faces":[0,1]},{"role":"cloth","faces":[0,1]}])"),
       "in: the key 'name' is missing"},
      {"json_crc32", "sequence_json", sequence_json("00000007", "0000000g"), "write eight hexadecimal digits"},
      {"frames_traversal", "frame_list", "{\"file\":\"a.npy\"}\n{\"file\":\"..\"}\n", "in:2: '..' is not the name"},
      {"frames_backslash", "frame_list", "{\"file\":\"..\\\\a\"}\n", "in:1: '..\\a' is not the name"},
      {"frames_blank_line", "frame_list", "{\"file\":\"a.npy\"}\n\n{\"file\":\"b.npy\"}\n", "in:2: not valid JSON"},
      {"frames_zero_for_line_end", "frame_list",
       "{\"file\":\"a.npy\"}\n{\"file\":\"b.npy\"}" + std::string(1, '\0') + "{\"file\":\"c.npy\"}\n",
       "in:2: a zero byte"},
      {"frames_zeros_for_a_line", "frame_list",
       "{\"file\":\"a.npy\"}" + std::string(17, '\0') + "{\"file\":\"c.npy\"}\n", "in:1: a zero byte"},
      {"frames_torn_in_the_middle", "frame_list", "{\"file\":\"a.n\n{\"file\":\"b.npy\"}\n", "in:1: not valid JSON"},
      {"frames_torn_but_ended", "frame_list", "{\"file\":\"a.npy\"}\n{\"fil\n", "in:2: not valid JSON"},
      {"frames_not_an_object", "frame_list", "[]\n", "in:1: not a JSON object"},
      {"frames_time_text", "frame_list", "{\"file\":\"a\",\"time\":\"0\"}\n", "in:1: \"time\" is not a number"},
      {"frames_time_back", "frame_list", "{\"file\":\"a\",\"time\":1}\n{\"file\":\"b\",\"time\":1}\n",
       "in:2: the time is not later"},
      {"frames_time_overflow", "frame_list", "{\"file\":\"a\",\"time\":1e999}\n", "in:1: "},
      {"frames_long_line", "frame_list", "{\"file\":\"" + std::string(5000, 'a') + "\"}\n",
       "in:1: the line is too long"},
      {"frames_deep", "frame_list", std::string(4000, '[') + "\n", "in:1: not a JSON object"},
  };
}

/// A sound cache of 4 vertices and 2 frames with `bytes` at `offset`.
std::string cache_with(std::string cache, std::size_t offset, const std::string& bytes) {
  return cache.replace(offset, bytes.size(), bytes);
}

std::vector<Hostile> hostile_caches() {
  const std::string pc2 = testing::pc2(4, 2), mdd = testing::mdd(4, {0, 1});
  const std::string nan_little("\0\0\xc0\x7f", 4), nan_big("\x7f\xc0\0\0", 4), zero(4, '\0'), minus_one(4, '\xff');
  const std::string infinity_big("\xff\x80\0\0", 4);
  return {
      {"pc2_empty", "pc2", "", "in: byte 0: the header is cut short"},
      {"pc2_header_cut", "pc2", pc2.substr(0, 31),
       "in: byte 31: the header is cut short: it needs 32 bytes, the file has 31;"},
      {"pc2_signature", "pc2", cache_with(pc2, 10, "3"), "in: byte 0: not 'POINTCACHE2'"},
      {"pc2_version", "pc2", cache_with(pc2, 12, "\2"), "in: byte 12: PC2 version 2 is not known"},
      {"pc2_big_endian", "pc2", cache_with(pc2, 12, std::string("\0\0\0\1", 4)), "in: byte 12: PC2 version 16777216"},
      {"pc2_no_vertices", "pc2", cache_with(pc2, 16, zero), "in: byte 16: the number of vertices is 0"},
      {"pc2_negative_vertices", "pc2", cache_with(pc2, 16, minus_one), "in: byte 16: the number of vertices is -1"},
      {"pc2_other_vertices", "pc2", testing::pc2(5, 2), "in: 5 vertices, the base mesh has 4"},
      {"pc2_no_frames", "pc2", cache_with(pc2, 28, zero), "in: byte 28: the number of frames is 0"},
      {"pc2_more_frames", "pc2", cache_with(pc2, 28, "\3"),
       "in: byte 128: 3 frames of 4 vertices make 176 bytes, the file has 128"},
      {"pc2_fewer_frames", "pc2", cache_with(pc2, 28, "\1"),
       "in: byte 80: 1 frames of 4 vertices make 80 bytes, the file has 128"},
      {"pc2_huge", "pc2", cache_with(cache_with(pc2, 16, "\xff\xff\xff\x7f"), 28, "\xff\xff\xff\x7f"),
       "in: byte 128: 2147483647 frames"},
      // 12 times their product is 2^64 and the 11,936 bytes that are there
      {"pc2_overflow", "pc2",
       cache_with(cache_with(pc2, 16, std::string("\x64\xca\x00\x40", 4)), 28, "\x7e\x47\x54\x55") +
           std::string(11840, '\0'),
       "in: byte 11968: 1431586686 frames of 1073793636 vertices make more than 18446744073709551615 bytes"},
      {"pc2_start_nan", "pc2", cache_with(pc2, 20, nan_little), "in: byte 20: the start frame or the sampling rate"},
      {"pc2_rate_nan", "pc2", cache_with(pc2, 24, nan_little), "in: byte 24: the start frame or the sampling rate"},
      {"pc2_rate_zero", "pc2", cache_with(pc2, 24, zero), "in: byte 24: the time of frame 1 is not later"},
      {"pc2_nan", "pc2", cache_with(pc2, 32 + 48 + 12 + 4, nan_little), "in: byte 96: frame 1, vertex 1 is not finite"},
      {"mdd_empty", "mdd", "", "in: byte 0: the header is cut short"},
      {"mdd_header_cut", "mdd", mdd.substr(0, 7), "in: byte 7: the header is cut short"},
      {"mdd_little_endian", "mdd", cache_with(mdd, 0, std::string("\2\0\0\0\4\0\0\0", 8)),
       "in: byte 112: 33554432 frames of 67108864 vertices"},
      {"mdd_no_frames", "mdd", cache_with(mdd, 0, zero), "in: byte 0: the number of frames is 0"},
      {"mdd_negative_vertices", "mdd", cache_with(mdd, 4, minus_one), "in: byte 4: the number of vertices is -1"},
      {"mdd_other_vertices", "mdd", testing::mdd(3, {0, 1}), "in: 3 vertices, the base mesh has 4"},
      {"mdd_more_frames", "mdd", cache_with(mdd, 3, "\3"),
       "in: byte 112: 3 frames of 4 vertices make 164 bytes, the file has 112"},
      {"mdd_huge", "mdd", cache_with(mdd, 0, "\x7f\xff\xff\xff\x7f\xff\xff\xff"), "in: byte 112: 2147483647 frames"},
      {"mdd_time_nan", "mdd", cache_with(mdd, 12, nan_big), "in: byte 12: the time of frame 1 is not finite"},
      {"mdd_time_back", "mdd", cache_with(mdd, 12, zero), "in: byte 12: the time of frame 1 is not later"},
      {"mdd_infinity", "mdd", cache_with(mdd, 16 + 48 + 12 + 8, infinity_big),
       "in: byte 84: frame 1, vertex 1 is not finite"},
  };
}

class HostileFile : public ::testing::TestWithParam<Hostile> {};

TEST_P(HostileFile, IsRefused) {
  const Hostile& file = GetParam();
  expect_error(ErrorKind::kBadInput, file.fragment, [&] { testing::parser_named(file.parser).parse(file.bytes); });
}

INSTANTIATE_TEST_SUITE_P(PointCaches, HostileFile, ::testing::ValuesIn(hostile_caches()),
                         [](const auto& of) { return of.param.name; });
INSTANTIATE_TEST_SUITE_P(All, HostileFile, ::testing::ValuesIn(hostile_files()),
                         [](const auto& of) { return of.param.name; });

/// A sound folder of two frames, to be damaged.
class HostileFolder : public ::testing::Test {
 protected:
  HostileFolder() {
    SequenceWriter writer(folder_.path(), {.triangles = {{0, 1, 2}}, .groups = {}, .producer = "test"});
    writer.append(0, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    writer.append(1, {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}});
  }
  void expect_refused(ErrorKind kind, const std::string& fragment) {
    expect_error(kind, fragment, [&] {
      const auto reader = open_sequence({folder_.path()});
      for (std::size_t i = 0; i < reader->frame_count(); ++i) (void)reader->frame(i);
    });
  }
  void replace(const std::string& file, const std::string& from, const std::string& to) {
    std::string bytes = slurp(folder_ / file);
    ASSERT_NE(bytes.find(from), bytes.npos);
    spit(folder_ / file, bytes.replace(bytes.find(from), from.size(), to));
  }
  void forget_checksums() {
    for (const std::string file : {"sequence.json", "frames.jsonl"}) {
      std::string bytes = slurp(folder_ / file);
      for (std::size_t at = 0; (at = bytes.find("\"crc32\"")) != bytes.npos;) {
        const std::size_t comma = bytes.rfind(',', at);
        bytes.erase(comma, bytes.find('}', at) - comma);
      }
      spit(folder_ / file, bytes);
    }
  }
  TemporaryFolder folder_;
};

TEST_F(HostileFolder, MissingFrame) {
  std::filesystem::remove(folder_ / "frame_000001.npy");
  expect_refused(ErrorKind::kFile, "frame_000001.npy: cannot open: No such file");
}

TEST_F(HostileFolder, OneBitOfAFrame) {
  std::string bytes = slurp(folder_ / "frame_000001.npy");
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  spit(folder_ / "frame_000001.npy", bytes);
  expect_refused(ErrorKind::kBadInput, "frame_000001.npy: the checksum differs");
  forget_checksums();
  EXPECT_EQ(open_sequence({folder_.path()})->frame(1).points.size(), 3u) << "checksums are optional";
}

TEST_F(HostileFolder, OneBitOfTheFaces) {
  std::string bytes = slurp(folder_ / "faces.npy");
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  spit(folder_ / "faces.npy", bytes);
  expect_refused(ErrorKind::kBadInput, "faces.npy: the checksum differs");
}

TEST_F(HostileFolder, FrameOfAnotherSize) {
  forget_checksums();
  spit(folder_ / "frame_000001.npy", npy(dictionary("<f8", "(2, 3)"), numbers<double>({1, 2, 3, 4, 5, 6})));
  expect_refused(ErrorKind::kBadInput, "frame_000001.npy: 2 vertices, the first frame has 3");
}

TEST_F(HostileFolder, FrameOfAnotherType) {
  forget_checksums();
  spit(folder_ / "frame_000001.npy", npy(dictionary("<f4", "(1, 3)"), numbers<float>({1, 2, 3})));
  expect_refused(ErrorKind::kBadInput, "frame_000001.npy: the type is not the precision");
}

TEST_F(HostileFolder, FacesBeyondTheVertices) {
  forget_checksums();
  spit(folder_ / "faces.npy", npy(dictionary("<i4", "(1, 3)"), numbers<std::int32_t>({0, 1, 3})));
  expect_refused(ErrorKind::kBadInput, "faces.npy: face 0 names vertex 3 of 3");
}

TEST_F(HostileFolder, GroupBeyondTheFaces) {
  replace("sequence.json", "\"groups\": []", R"("groups": [{"name": "a", "role": "cloth", "faces": [0, 2]}])");
  expect_refused(ErrorKind::kBadInput, "sequence.json: the group 'a' is not within the 1 faces");
}

TEST_F(HostileFolder, FrameIsAFolder) {
  std::filesystem::remove(folder_ / "frame_000001.npy");
  std::filesystem::create_directory(folder_ / "frame_000001.npy");
  expect_refused(ErrorKind::kFile, "frame_000001.npy: cannot read: Is a directory");
}

TEST_F(HostileFolder, NoFrameList) {
  std::filesystem::remove(folder_ / "frames.jsonl");
  expect_refused(ErrorKind::kFile, "frames.jsonl: cannot open");
}

TEST_F(HostileFolder, NamesWithLineBreaksStayInOneLine) {
  spit(folder_ / "a\nb.obj", "x");
  expect_error(ErrorKind::kBadInput, "a?b.obj:1: 'x'", [&] { (void)open_sequence({folder_ / "a\nb.obj"}); });
}

}  // namespace
}  // namespace selvage::io
