// Writes VTK's XML: a .vtp a frame, and the .pvd that lists them with their times, last.
// Source: VTK File Formats, "XML File Formats", appended raw data; the blocks start with their size in bytes.
#include <charconv>
#include <utility>

#include "io/fail.h"
#include "io/file/atomic_file.h"
#include "io/file/byte_order.h"
#include "io/file/fp_guard.h"
#include "io/file/text.h"
#include "io/points.h"
#include "io/sequence/sequence_outputs.h"

namespace selvage::io {
namespace fs = std::filesystem;
namespace {

/// One array: its element in the XML, and its bytes behind it.
class Blocks {
 public:
  std::string add(const std::string& attributes, const std::string& bytes) {
    const std::string element =
        "<DataArray " + attributes + " format=\"appended\" offset=\"" + std::to_string(data_.size()) + "\"/>\n";
    append(data_, static_cast<std::uint64_t>(bytes.size()), std::endian::little);
    data_ += bytes;
    return element;
  }
  const std::string& data() const { return data_; }

 private:
  std::string data_;
};

std::string escaped(const std::string& text, const std::string& name) {
  std::string xml;
  for (const char c : text) {
    if (static_cast<unsigned char>(c) < ' ') bad_input(name, "XML cannot hold this name; choose another");
    switch (c) {
      case '&':
        xml += "&amp;";
        break;
      case '<':
        xml += "&lt;";
        break;
      case '"':
        xml += "&quot;";
        break;
      default:
        xml += c;
    }
  }
  if (!is_utf8(text)) bad_input(name, "the name is not UTF-8, as XML must be; choose another");
  return xml;
}

const char* const kXml = "<?xml version=\"1.0\"?>\n";

class PvdOutput final : public SequenceOutput {
 public:
  PvdOutput(fs::path file, OutputHeader all) : SequenceOutput(std::move(file), std::move(all)) {
    (void)escaped(target().stem().string(), target().string());
    require_absent(target());
    for (std::size_t i = 0; i < header().frame_count; ++i) require_absent(frame_path(target(), i, ".vtp"));
  }
  std::vector<fs::path> sources() const override { return {target()}; }

 private:
  void write_frame(double time_s, const MeshData& mesh) override {
    const FpGuard guard;
    const fs::path file = frame_path(target(), frame_count(), ".vtp");
    written_.write(file, vtp_bytes(mesh));
    char digits[32];
    const std::string time(digits, std::to_chars(digits, digits + sizeof digits, time_s).ptr);
    list_ += "<DataSet timestep=\"" + time + "\" part=\"0\" file=\"" +
             escaped(file.filename().string(), target().string()) + "\"/>\n";
  }
  void commit() override {
    written_.write(target(), std::string(kXml) +
                                 "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
                                 "<Collection>\n" +
                                 list_ + "</Collection>\n</VTKFile>\n");
    written_.keep();
  }

  std::string list_;
  WrittenFiles written_;
};

}  // namespace

std::string vtp_bytes(const MeshData& mesh) {
  const bool is_float32 = mesh.precision == Precision::kFloat32;
  std::string points, corners, ends;
  append_points(points, mesh.points, mesh.precision, "vtp");
  for (std::size_t face = 0; face < mesh.triangles.size(); ++face) {
    for (const std::int32_t corner : mesh.triangles[face]) append(corners, std::int64_t{corner}, std::endian::little);
    append(ends, static_cast<std::int64_t>(3 * (face + 1)), std::endian::little);
  }
  Blocks blocks;
  std::string xml = std::string(kXml) +
                    "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
                    "<PolyData>\n<Piece NumberOfPoints=\"" +
                    std::to_string(mesh.points.size()) +
                    "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" +
                    std::to_string(mesh.triangles.size()) + "\">\n";
  xml += "<Points>\n" +
         blocks.add(std::string("type=\"") + (is_float32 ? "Float32" : "Float64") +
                        "\" Name=\"Points\" NumberOfComponents=\"3\"",
                    points) +
         "</Points>\n";
  xml += "<Polys>\n" + blocks.add("type=\"Int64\" Name=\"connectivity\"", corners);
  xml += blocks.add("type=\"Int64\" Name=\"offsets\"", ends) + "</Polys>\n";
  xml += "<CellData>\n" + blocks.add("type=\"UInt8\" Name=\"group\"", role_bytes(mesh.triangles.size(), mesh.groups)) +
         "</CellData>\n";
  xml += "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
  return xml + blocks.data() + "\n</AppendedData>\n</VTKFile>\n";
}

std::unique_ptr<SequenceOutput> create_pvd_output(fs::path target, OutputHeader header) {
  return std::make_unique<PvdOutput>(std::move(target), std::move(header));
}

}  // namespace selvage::io
