#include "fuzz/file_formats.h"

#include <algorithm>
#include <cmath>

#include "fuzz/case_file.h"
#include "fuzz/overlap_case.h"
#include "io/checksum.h"
#include "io/mesh_reader.h"
#include "io/npy.h"
#include "io/point_cache.h"
#include "io/query_csv.h"
#include "io/sequence_json.h"
#include "io/sequence_readers.h"
#include "sim/scene_reader.h"

namespace selvage::fuzz {
namespace {

const std::string kName = "fuzzed";

template <class Parse>
ParseResult guarded(const Parse& parse) {
  try {
    return parse() ? ParseResult::kAccepted : ParseResult::kUnsound;
  } catch (const io::Error&) {
    return ParseResult::kRefused;
  }
}

bool is_finite(const io::Points& points) {
  return std::ranges::all_of(
      points, [](const auto& p) { return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]); });
}

bool is_sound(const io::MeshData& mesh) {
  const auto vertex_count = static_cast<std::int64_t>(mesh.points.size());
  const bool in_range = std::ranges::all_of(mesh.triangles, [&](const auto& triangle) {
    return std::ranges::all_of(triangle, [&](std::int32_t v) { return v >= 0 && v < vertex_count; });
  });
  return in_range && is_finite(mesh.points);
}

bool is_sound(const io::SequenceReader& sequence) {
  bool sound = true;
  for (std::size_t i = 0; i < sequence.frame_count(); ++i) sound = sound && is_sound(sequence.frame(i));
  return sound;
}

ParseResult parse_obj(std::string_view bytes) {
  return guarded([&] { return is_sound(io::parse_obj(bytes, kName)); });
}
ParseResult parse_ply(std::string_view bytes) {
  return guarded([&] { return is_sound(io::parse_ply(bytes, kName)); });
}
ParseResult parse_npy(std::string_view bytes) {
  return guarded([&] { return is_finite(io::parse_npy_points(bytes, kName).points); });
}
ParseResult parse_npz(std::string_view bytes) {
  return guarded([&] { return is_sound(*io::open_npz_sequence(io::in_memory(std::string(bytes)), kName)); });
}

io::MeshData one_triangle() {
  io::MeshData mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}
template <io::PointCacheFormat kFormat>
ParseResult parse_cache(std::string_view bytes) {
  return guarded([&] {
    return is_sound(*io::open_point_cache(io::in_memory(std::string(bytes)), kFormat, one_triangle(), kName));
  });
}

ParseResult parse_csv(std::string_view bytes) {
  return guarded([&] {
    return std::ranges::all_of(io::parse_query_csv(bytes, kName), [](const io::CcdQuery& query) {
      return is_finite(io::Points(query.points.begin(), query.points.end()));
    });
  });
}
ParseResult parse_header(std::string_view bytes) {
  return guarded([&] {
    const std::vector<io::Group> groups = io::parse_sequence_json(bytes, kName).groups;
    return std::ranges::all_of(groups, [](const auto& g) { return 0 <= g.face_begin && g.face_begin <= g.face_end; });
  });
}
ParseResult parse_frames(std::string_view bytes) {
  return guarded([&] {
    return std::ranges::all_of(io::parse_frame_list(bytes, kName),
                               [](const io::FrameRecord& frame) { return std::isfinite(frame.time_s); });
  });
}
ParseResult parse_scene(std::string_view bytes) {
  return guarded([&] { return sim::parse_scene(bytes, kName).time.frames_per_s > 0; });
}
ParseResult parse_case(std::string_view bytes) {
  return guarded([&] { return std::isfinite(max_coordinate(fuzz::parse_case(bytes, kName).query)); });
}
ParseResult parse_overlap(std::string_view bytes) {
  return guarded([&] {
    for (const auto& face : fuzz::parse_overlap_case(bytes, kName).x) {
      if (!is_finite(io::Points(face.begin(), face.end()))) return false;
    }
    return true;
  });
}

std::string bytes_of(const std::vector<float>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

std::string big_endian(std::uint32_t word) {
  return {static_cast<char>(word >> 24), static_cast<char>(word >> 16), static_cast<char>(word >> 8),
          static_cast<char>(word)};
}

const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0.5\ng a\nf 1/1/1 2//2 3\nf -1 -2 -3\n";
const std::string kPly =
    "ply\nformat ascii 1.0\ncomment x\nelement vertex 3\nproperty float x\nproperty double y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string kBinaryPly = std::string(
                                   "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty "
                                   "float y\nproperty float z\nelement face 1\nproperty list uchar uchar "
                                   "vertex_index\nend_header\n") +
                               bytes_of({0, 0, 0, 1, 0, 0, 0, 1, 0}) + std::string("\3\0\1\2", 4);
const std::string kScene =
    "gravity_m_s2 = [0, 0, -9.81]\n[time]\nframes = 2\n[[cloth]]\nsheet = {nx = 2, ny = 3, width_m = 1, height_m = 1}\n"
    "density_kg_m2 = 0.2\nstretch_n_m = 50\n[[cloth.pin]]\nedge = \"top\"\n[[body]]\nsphere = {radius_m = 0.3}\n"
    "[[body.key]]\ntime_s = 1\nposition_m = [0, 0, 1]\n";
const std::string kCase =
    "selvage-case 1 self\nseed x:1\noptions tolerance=0x1p-20 max_intervals=4096\np 0x1p+0 1 -0x1.8p-3  0 0 0\n"
    "a 0 0 0  1 0 0\nb 0 1 0  0 1 1\nexpect apart\n";

std::string overlap_sample() {
  OverlapCase kept;
  kept.faces = {{{0, 1, 2}, {3, 4, 5}}};
  kept.seed = "x:1";
  return format_overlap_case(kept);
}

std::string little_endian(std::uint64_t value, int byte_count) {
  std::string bytes;
  for (int i = 0; i < byte_count; ++i) bytes += static_cast<char>(value >> (8 * i));
  return bytes;
}

/// A zip archive whose members are stored, as numpy.savez writes it (APPNOTE, 4.3.7, 4.3.12 and 4.3.16).
std::string stored_zip(const std::vector<std::pair<std::string, std::string>>& members) {
  std::string files, directory;
  for (const auto& [name, content] : members) {
    const std::string common = little_endian(0x14, 2) + little_endian(0, 8) + little_endian(io::crc32(content), 4) +
                               little_endian(content.size(), 4) + little_endian(content.size(), 4) +
                               little_endian(name.size(), 2) + little_endian(0, 2);
    directory +=
        "PK\1\2" + little_endian(0x14, 2) + common + little_endian(0, 10) + little_endian(files.size(), 4) + name;
    files += "PK\3\4" + common + name + content;
  }
  return files + directory + "PK\5\6" + little_endian(0, 4) + little_endian(members.size(), 2) +
         little_endian(members.size(), 2) + little_endian(directory.size(), 4) + little_endian(files.size(), 4) +
         little_endian(0, 2);
}

std::vector<FileFormat> make_formats() {
  const std::string points = io::npy_bytes({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, io::Precision::kFloat64, kName);
  const std::string faces = io::npy_bytes(io::Triangles{{0, 1, 2}});
  const std::string pc2 = io::pc2_header(3, 2) + bytes_of({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1});
  std::string mdd = big_endian(1) + big_endian(3) + big_endian(0);
  for (int i = 0; i < 9; ++i) mdd += big_endian(0x3f800000U * static_cast<std::uint32_t>(i % 2));
  std::string csv;
  for (int row = 0; row < 8; ++row) csv += std::to_string(row) + ",4,1,2,3,1," + "0\n";
  const std::string header = io::to_json(io::SequenceDescription{
      .producer = "x", .groups = {{"a", io::Group::Role::kBody, 0, 2}}, .faces_file = "f", .faces_crc32 = 7});
  const std::string frames =
      io::to_json(io::FrameRecord{"a", -0.5, 7}) + io::to_json(io::FrameRecord{"b", 1e-3, std::nullopt});
  return {{"obj", {kObj}, parse_obj},
          {"ply", {kPly, kBinaryPly}, parse_ply},
          {"npy", {points}, parse_npy},
          {"npz", {stored_zip({{"V.npy", points}, {"F.npy", faces}})}, parse_npz},
          {"pc2", {pc2}, parse_cache<io::PointCacheFormat::kPc2>},
          {"mdd", {mdd}, parse_cache<io::PointCacheFormat::kMdd>},
          {"csv", {csv}, parse_csv},
          {"scene", {kScene}, parse_scene},
          {"case", {kCase}, parse_case},
          {"overlap", {overlap_sample()}, parse_overlap},
          {"header", {header}, parse_header},
          {"frames", {frames}, parse_frames}};
}

}  // namespace

const std::vector<FileFormat>& file_formats() {
  static const std::vector<FileFormat> formats = make_formats();
  return formats;
}

}  // namespace selvage::fuzz
