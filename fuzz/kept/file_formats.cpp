#include "fuzz/kept/file_formats.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fuzz/kept/case_file.h"
#include "fuzz/kept/file_samples.h"
#include "fuzz/kept/kept_case.h"
#include "fuzz/kept/overlap_case.h"
#include "fuzz/ledger/ledger.h"
#include "io/format/npy.h"
#include "io/mesh_reader.h"
#include "io/query_csv.h"
#include "io/sequence/sequence_json.h"
#include "io/sequence/sequence_readers.h"
#include "sim/scene/scene_reader.h"
#include "verify/report/report.h"

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

bool are_sound(const io::Triangles& triangles, std::int64_t vertex_count) {
  return std::ranges::all_of(triangles, [&](const auto& triangle) {
    const bool distinct = triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0];
    return distinct && std::ranges::all_of(triangle, [&](std::int32_t v) { return v >= 0 && v < vertex_count; });
  });
}

bool are_sound(const std::vector<io::Group>& groups, std::int64_t face_count) {
  return std::ranges::all_of(groups, [&](const io::Group& group) {
    return 0 <= group.face_begin && group.face_begin <= group.face_end && group.face_end <= face_count;
  });
}

bool is_sound(const io::MeshData& mesh) {
  return are_sound(mesh.triangles, std::ssize(mesh.points)) && are_sound(mesh.groups, std::ssize(mesh.triangles)) &&
         is_finite(mesh.points);
}

/// A name that stays in its folder.
bool is_plain(const std::string& file) {
  return !file.empty() && file != "." && file != ".." && file.find_first_of(std::string_view("/\\\0", 3)) == file.npos;
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
ParseResult parse_npy_triangles(std::string_view bytes) {
  return guarded([&] { return are_sound(io::parse_npy_triangles(bytes, kName), std::int64_t{1} << 31); });
}
ParseResult parse_npy_integers(std::string_view bytes) {
  return guarded([&] { return io::parse_npy_integers(bytes, kName).size() <= bytes.size(); });
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
    const io::SequenceDescription description = io::parse_sequence_json(bytes, kName);
    return is_plain(description.faces_file) && are_sound(description.groups, std::numeric_limits<std::int64_t>::max());
  });
}
ParseResult parse_frames(std::string_view bytes) {
  return guarded([&] {
    double before = -std::numeric_limits<double>::infinity();
    return std::ranges::all_of(io::parse_frame_list(bytes, kName), [&](const io::FrameRecord& frame) {
      return is_plain(frame.file) && std::isfinite(frame.time_s) && std::exchange(before, frame.time_s) < frame.time_s;
    });
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

// What is written and read again by other runs: reading it must not change it.
ParseResult parse_report(std::string_view bytes) {
  return guarded([&] {
    const auto written = [](const std::string& text) {
      const verify::ParsedReport parsed = verify::parse_report(text, kName);
      return verify::json_report(parsed.report, parsed.context);
    };
    const std::string once = written(std::string(bytes));
    return written(once) == once;
  });
}
ParseResult parse_campaign(std::string_view bytes) {
  return guarded([&] {
    const Ledger ledger = parse_ledger(std::string(bytes), kName);
    return parse_ledger(to_json(ledger), kName) == ledger;
  });
}

/// Nothing is run here, and whatever a drawn case calls its property is read: the properties are above.
std::optional<Redrawn> redraw_nothing(const CaseOrigin& /*origin*/) { return Redrawn{}; }

ParseResult parse_kept(std::string_view bytes) {
  return guarded([&] {
    const ParsedCase parsed = parse_kept_case(bytes, kName, redraw_nothing);
    const std::string text = kept_text(*parsed.kept, parsed.origin, parsed.failure);
    return kept_text(*parse_kept_case(text, kName, redraw_nothing).kept, parsed.origin, parsed.failure) == text;
  });
}

std::vector<FileFormat> make_formats() {
  std::vector<FileFormat> formats = {{"obj", {}, parse_obj},
                                     {"ply", {}, parse_ply},
                                     {"npy", {}, parse_npy},
                                     {"npy-triangles", {}, parse_npy_triangles},
                                     {"npy-integers", {}, parse_npy_integers},
                                     {"npz", {}, parse_npz},
                                     {"pc2", {}, parse_cache<io::PointCacheFormat::kPc2>},
                                     {"mdd", {}, parse_cache<io::PointCacheFormat::kMdd>},
                                     {"csv", {}, parse_csv},
                                     {"header", {}, parse_header},
                                     {"frames", {}, parse_frames},
                                     {"scene", {}, parse_scene},
                                     {"case", {}, parse_case},
                                     {"overlap", {}, parse_overlap},
                                     {"kept", {}, parse_kept},
                                     {"report", {}, parse_report},
                                     {"campaign", {}, parse_campaign}};
  for (FileFormat& format : formats) format.samples = file_samples(format.name);
  return formats;
}

}  // namespace

const std::vector<FileFormat>& file_formats() {
  static const std::vector<FileFormat> formats = make_formats();
  return formats;
}

}  // namespace selvage::fuzz
