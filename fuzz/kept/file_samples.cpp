#include "fuzz/kept/file_samples.h"

#include "fuzz/kept/overlap_case.h"
#include "fuzz/ledger/ledger.h"
#include "io/file/checksum.h"
#include "io/format/npy.h"
#include "io/point_cache.h"
#include "io/sequence/sequence_json.h"
#include "kernel/assert.h"
#include "verify/report/report.h"

namespace selvage::fuzz {
namespace {

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

const std::string kKeptMesh =
    "selvage-case 1 subdivision\nseed subdivision:soup:1:2\nfailure touches\nset levels 1\nvertices 3\nv 0 0 0  0\n"
    "v 0x1p+0 0 0  1\nv 0 -0x1.8p-3 0  0\nfaces 1\nf 0 1 2\n";
const std::string kKeptFile =
    "selvage-case 1 file\nseed files:obj:1:2\nfailure unsound\nformat obj\n| v 0 0\\x20\n| \\\\0 \\n\n| f 1\n";

std::string overlap_text() {
  OverlapCase kept;
  kept.faces = {{{0, 1, 2}, {3, 4, 5}}};
  kept.seed = "x:1";
  return format_overlap_case(kept);
}

std::string little_endian(std::uint64_t value, int byte_count) {
  std::string bytes;
  for (int i = 0; i < byte_count; ++i) bytes += static_cast<char>(i < 8 ? value >> (8 * i) : 0);
  return bytes;
}

enum class Method : std::uint8_t { kStored = 0, kDeflated = 8 };

/// A zip archive as numpy.savez or savez_compressed writes it (APPNOTE, 4.3.7, 4.3.12 and 4.3.16).
std::string zip(const std::vector<std::pair<std::string, std::string>>& members, Method method) {
  std::string files, directory;
  for (const auto& [name, content] : members) {
    std::string packed = content;
    if (method == Method::kDeflated) {  // one block without compression: RFC 1951, 3.2.4
      packed = "\1" + little_endian(content.size(), 2) + little_endian(~content.size(), 2) + content;
    }
    const std::string common = little_endian(0x14, 2) + little_endian(0, 2) +
                               little_endian(static_cast<std::uint64_t>(method), 2) + little_endian(0, 4) +
                               little_endian(io::crc32(content), 4) + little_endian(packed.size(), 4) +
                               little_endian(content.size(), 4) + little_endian(name.size(), 2) + little_endian(0, 2);
    directory +=
        "PK\1\2" + little_endian(0x14, 2) + common + little_endian(0, 10) + little_endian(files.size(), 4) + name;
    files += "PK\3\4" + common + name + packed;
  }
  return files + directory + "PK\5\6" + little_endian(0, 4) + little_endian(members.size(), 2) +
         little_endian(members.size(), 2) + little_endian(directory.size(), 4) + little_endian(files.size(), 4) +
         little_endian(0, 2);
}

std::string point_array() {
  return io::npy_bytes({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, io::Precision::kFloat64, "sample");
}

std::string mdd_bytes() {
  std::string mdd = big_endian(1) + big_endian(3) + big_endian(0);
  for (int i = 0; i < 9; ++i) mdd += big_endian(0x3f800000U * static_cast<std::uint32_t>(i % 2));
  return mdd;
}

std::string csv_text() {
  std::string csv;
  for (int row = 0; row < 8; ++row) csv += std::to_string(row) + ",4,1,2,3,1," + "0\n";
  return csv;
}

std::string header_text() {
  using Role = io::Group::Role;
  return io::to_json(io::SequenceDescription{"x",
                                             io::SequenceKind::kSteps,
                                             io::Precision::kFloat32,
                                             {{"a", Role::kCloth, 0, 5}, {"b", Role::kBody, 5, 9}},
                                             "faces.npy",
                                             0x12345678});
}

/// A report in which there is something of everything.
std::string report_text() {
  verify::SequenceReport report;
  report.frames = {2, 0};
  report.motions = {1, 1};
  report.frames_expected = 2;
  report.motions_expected = 1;
  report.sequence = "2 frames";
  report.frame_count = report.end_frame = 2;
  report.frame_crc32 = {1, 2};
  report.violations_total.vf = 1;
  report.violated = {{0, true, report.violations_total}};
  verify::Violation violation;
  violation.motion = true;
  violation.event = verify::EventKind::kVf;
  violation.kind = "touch";
  violation.vertices = {0, 1, 2, 3, -1, -1};
  violation.x_t0 = violation.x_t1 = violation.at_touch = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0.5}};
  violation.case_file = "cases/a.case";
  report.violations = {violation};
  report.second_opinion = verify::SecondOpinionScope::kAll;
  report.disagreements = {violation};
  report.pairs.disagreed = 1;
  report.max_violations = 1;
  report.gap_searched = true;
  report.gap = {0.5, 0.5, 1, verify::EventKind::kEe, {0, 1}};
  report.unchecked = {"frame 1"};
  report.exempted = {{{"a", "b"}, 3}};
  report.ignored = {{"c", 1}};
  report.welded = {1, 0};
  report.verdict = verify::verdict_of(report);
  return verify::json_report(report, {"x", {"a.obj"}, {{0, "a"}, {1, "b"}}, {{"option", "1"}}});
}

std::string campaign_text() {
  PropertyLedger property;
  property.name = "ccd";
  property.units.insert(0, 3);
  property.units.insert(7);
  property.streams = {"one vf"};
  property.counters = {"touches"};
  property.rows = {{4, 1, {2}, 53}};
  property.findings[{"one vf", "missed"}] = {1, 2, "a.case"};
  return to_json(Ledger{"x", "selvage", 1, 4, 1, 2, {property}});
}

}  // namespace

std::vector<std::string> file_samples(std::string_view format) {
  const std::vector<std::pair<std::string, std::string>> members{{"V.npy", point_array()},
                                                                 {"F.npy", io::npy_bytes(io::Triangles{{0, 1, 2}})}};
  const std::vector<std::pair<std::string_view, std::vector<std::string>>> all = {
      {"obj", {kObj}},
      {"ply", {kPly, kBinaryPly}},
      {"npy", {point_array()}},
      {"npy-triangles", {members[1].second}},
      {"npy-integers", {io::npy_start("<i2", {3}) + std::string("\0\0\1\0\377\377", 6)}},
      {"npz", {zip(members, Method::kStored), zip(members, Method::kDeflated)}},
      {"pc2", {io::pc2_header(3, 2) + bytes_of({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 0, 1, 1})}},
      {"mdd", {mdd_bytes()}},
      {"csv", {csv_text()}},
      {"header", {header_text()}},
      {"frames", {io::to_json(io::FrameRecord{"a.npy", -0.5, 7}) + io::to_json(io::FrameRecord{"b.npy", 1e-3, {}})}},
      {"scene", {kScene}},
      {"case", {kCase}},
      {"overlap", {overlap_text()}},
      {"kept", {kKeptMesh, kKeptFile}},
      {"report", {report_text()}},
      {"campaign", {campaign_text()}}};
  for (const auto& [name, samples] : all) {
    if (name == format) return samples;
  }
  SELVAGE_ASSERT(false);
  return {};
}

}  // namespace selvage::fuzz
