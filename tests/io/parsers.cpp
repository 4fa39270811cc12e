#include "tests/io/parsers.h"

#include <cmath>
#include <stdexcept>

#include "io/format/npy.h"
#include "io/mesh_reader.h"
#include "io/query_csv.h"
#include "io/sequence/sequence_json.h"
#include "io/sequence/sequence_readers.h"
#include "tests/io/npy_builder.h"
#include "tests/io/point_cache_builder.h"
#include "tests/io/zip_writer.h"

namespace selvage::testing {
namespace {

void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(std::string("accepted, but ") + what);
}

void check_points(const io::Points& points) {
  for (const auto& point : points) {
    for (const double x : point) require(std::isfinite(x), "a coordinate is not finite");
  }
}

void check_mesh(const io::MeshData& mesh) {
  check_points(mesh.points);
  for (const auto& face : mesh.triangles) {
    for (const std::int32_t vertex : face) {
      require(vertex >= 0 && static_cast<std::size_t>(vertex) < mesh.points.size(), "an index is out of range");
    }
    require(face[0] != face[1] && face[1] != face[2] && face[2] != face[0], "a corner is repeated");
  }
  for (const io::Group& group : mesh.groups) {
    require(0 <= group.face_begin && group.face_begin <= group.face_end, "a group's range is reversed");
    require(static_cast<std::size_t>(group.face_end) <= mesh.triangles.size(), "a group is beyond the faces");
  }
}

void parse_obj(const std::string& bytes) { check_mesh(io::parse_obj(bytes, "in")); }
void parse_ply(const std::string& bytes) { check_mesh(io::parse_ply(bytes, "in")); }
void parse_npy_points(const std::string& bytes) { check_points(io::parse_npy_points(bytes, "in").points); }
void parse_npy_integers(const std::string& bytes) { (void)io::parse_npy_integers(bytes, "in"); }

void parse_npy_triangles(const std::string& bytes) {
  for (const auto& face : io::parse_npy_triangles(bytes, "in")) {
    require(face[0] >= 0 && face[1] >= 0 && face[2] >= 0, "an index is negative");
    require(face[0] != face[1] && face[1] != face[2] && face[2] != face[0], "a corner is repeated");
  }
}

void parse_npz(const std::string& bytes) {
  const auto reader = io::open_npz_sequence(io::in_memory(bytes), "in");
  require(reader->frame_count() <= bytes.size(), "there are more frames than bytes");
  for (std::size_t i = 0; i < reader->frame_count(); ++i) check_mesh(reader->frame(i));
}

/// The mesh that the caches of the tests move.
io::MeshData base_mesh() {
  io::MeshData base;
  base.points.resize(4);
  base.triangles = {{0, 1, 2}, {2, 1, 3}};
  return base;
}

void parse_point_cache(const std::string& bytes, io::PointCacheFormat format) {
  const auto reader = io::open_point_cache(io::in_memory(bytes), format, base_mesh(), "in");
  require(reader->frame_count() <= bytes.size(), "there are more frames than bytes");
  for (std::size_t i = 0; i < reader->frame_count(); ++i) {
    const io::MeshData mesh = reader->frame(i);
    check_mesh(mesh);
    require(mesh.points.size() == 4, "a frame has not the vertices of the base mesh");
    require(std::isfinite(reader->time(i)), "a time is not finite");
    require(i == 0 || reader->time(i - 1) < reader->time(i), "times do not increase");
  }
}
void parse_pc2(const std::string& bytes) { parse_point_cache(bytes, io::PointCacheFormat::kPc2); }
void parse_mdd(const std::string& bytes) { parse_point_cache(bytes, io::PointCacheFormat::kMdd); }

void parse_query_csv(const std::string& bytes) {
  for (const io::CcdQuery& query : io::parse_query_csv(bytes, "in")) {
    check_points({query.points.begin(), query.points.end()});
  }
}

void require_plain(const std::string& file) {
  require(!file.empty() && file != "." && file != ".." && file.find_first_of(std::string_view("/\\\0", 3)) == file.npos,
          "a file name leaves the folder");
}

void parse_sequence_json(const std::string& bytes) {
  const io::SequenceDescription description = io::parse_sequence_json(bytes, "in");
  require_plain(description.faces_file);
  for (const io::Group& group : description.groups) {
    require(0 <= group.face_begin && group.face_begin <= group.face_end, "a group's range is reversed");
  }
}

void parse_frame_list(const std::string& bytes) {
  const std::vector<io::FrameRecord> frames = io::parse_frame_list(bytes, "in");
  for (std::size_t i = 0; i < frames.size(); ++i) {
    require_plain(frames[i].file);
    require(std::isfinite(frames[i].time_s), "a time is not finite");
    require(i == 0 || frames[i - 1].time_s < frames[i].time_s, "times do not increase");
  }
}

const std::string kPlyHeader =
    " 1.0\ncomment x\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
    "element face 2\nproperty list uchar int vertex_indices\nproperty float quality\nend_header\n";

std::string binary_ply(std::endian order) {
  const io::Points points = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5}};
  std::string bytes =
      std::string("ply\nformat binary_") + (order == std::endian::big ? "big" : "little") + "_endian" + kPlyHeader;
  for (const auto& point : points) {
    for (const double x : point) io::append(bytes, static_cast<float>(x), order);
    bytes += '\x7f';
  }
  for (const auto& corners : {std::vector{0, 1, 2, 3}, std::vector{3, 1, 0}}) {
    bytes += static_cast<char>(corners.size());
    for (const int corner : corners) io::append(bytes, std::int32_t{corner}, order);
    io::append(bytes, 1.0f, order);
  }
  return bytes;
}

std::vector<std::string> sound_npz() {
  const std::string v =
      npy(dictionary("<f8", "(2, 3, 3)"), numbers<double>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1}));
  const std::string f = npy(dictionary("<i4", "(2, 3)"), numbers<std::int32_t>({0, 1, 2, 2, 1, 0}));
  const std::string group = npy(dictionary("|u1", "(2,)"), numbers<std::uint8_t>({0, 1}));
  std::vector<std::string> files;
  for (const bool deflate : {false, true}) {
    for (const bool zip64 : {false, true}) {
      files.push_back(zip({{.name = "V.npy", .content = v, .deflate = deflate},
                           {.name = "F.npy", .content = f, .deflate = deflate},
                           {.name = "group.npy", .content = group, .deflate = deflate}},
                          zip64));
    }
  }
  return files;
}

std::vector<Parser> make_parsers() {
  const std::string query_row = "6004799503160661,36028797018963968,-3,4,0,1";
  std::string queries;
  for (int row = 0; row < 16; ++row) queries += query_row + ",1\n";
  return {
      {"obj",
       parse_obj,
       {"# c\no a\nv 0 0 0\nv 1 -0.5 1e-3\nv +1 1 .5\nv 0 1 0 1 0 0\nvt 0 1\nvn 0 0 1\ng left\nf 1 2 3 4\ng right\nf "
        "-1//1 1/1 \\\n2/1/1\n",
        "v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n"}},
      {"ply",
       parse_ply,
       {"ply\nformat ascii" + kPlyHeader + "0 0 0 9\n1 0 0 9\n1 1 0.25 9\n0 1e0 0 255\n4 0 1 2 3 0.5\n3 0 1 3 nan\n",
        binary_ply(std::endian::little), binary_ply(std::endian::big)}},
      {"npy_points",
       parse_npy_points,
       {npy(dictionary("<f8", "(2, 3)"), numbers<double>({1, 2, 3, 4, 5, 6})),
        npy(dictionary(">f4", "(2, 3)", true), numbers<float>({1, 2, 3, 4, 5, 6}, std::endian::big), 2)}},
      {"npy_triangles",
       parse_npy_triangles,
       {npy(dictionary("<i4", "(2, 3)"), numbers<std::int32_t>({0, 1, 2, 2, 1, 3})),
        npy(dictionary(">u8", "(2, 3)", true), numbers<std::uint64_t>({0, 1, 2, 2, 1, 3}, std::endian::big), 3)}},
      {"npy_integers", parse_npy_integers, {npy(dictionary("<i2", "(4,)"), numbers<std::int16_t>({0, 1, -1, 300}))}},
      {"npz", parse_npz, sound_npz()},
      {"pc2", parse_pc2, {pc2(4, 2), pc2(4, 1)}},
      {"mdd", parse_mdd, {mdd(4, {0, 0.04f}), mdd(4, {-1})}},
      {"query_csv", parse_query_csv, {queries, queries.substr(0, queries.size() / 2)}},
      {"sequence_json",
       parse_sequence_json,
       {io::to_json(io::SequenceDescription{"test",
                                            io::SequenceKind::kSteps,
                                            io::Precision::kFloat32,
                                            {{"a", io::Group::Role::kCloth, 0, 5}, {"b", io::Group::Role::kBody, 5, 9}},
                                            "faces.npy",
                                            0x12345678})}},
      {"frame_list",
       parse_frame_list,
       {io::to_json(io::FrameRecord{"frame_000000.npy", -0.5, 7}) + io::to_json(io::FrameRecord{"b.npy", 1e-3, {}})}},
  };
}

}  // namespace

const std::vector<Parser>& all_parsers() {
  static const std::vector<Parser> parsers = make_parsers();
  return parsers;
}

const Parser& parser_named(const std::string& name) {
  for (const Parser& parser : all_parsers()) {
    if (parser.name == name) return parser;
  }
  throw std::logic_error("no parser " + name);
}

}  // namespace selvage::testing
