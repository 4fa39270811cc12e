// PLY: the elements "vertex" (x, y, z) and "face" (vertex_indices); other properties and elements are skipped.
#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include "io/fail.h"
#include "io/file/fp_guard.h"
#include "io/format/ply_header.h"
#include "io/format/ply_records.h"
#include "io/format/polygon.h"
#include "io/mesh_reader.h"

namespace selvage::io {
namespace {

template <typename Records>
void skip_property(Records& records, const PlyProperty& property) {
  std::int64_t count = 1;
  if (property.list_count) count = records.integer(*property.list_count);
  if (count < 0) records.fail("a list has a negative count; correct it");
  records.skip(property.type, count);
}

/// What to read of the elements, found in the header.
struct PlyLayout {
  const PlyElement* vertex = nullptr;
  const PlyElement* face = nullptr;
  std::array<std::size_t, 3> axes = {};
  std::size_t corner_list = 0;
};

template <typename Records>
void read_vertices(Records& records, const PlyElement& element, const std::array<std::size_t, 3>& axes,
                   MeshData& mesh) {
  mesh.points.reserve(element.count);  // believable: the header was checked against the bytes
  for (std::uint64_t i = 0; i < element.count; ++i) {
    std::array<double, 3> point = {};
    records.begin_record();
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const auto axis = static_cast<std::size_t>(std::find(axes.begin(), axes.end(), p) - axes.begin());
      if (axis < 3) {
        point[axis] = records.real(element.properties[p].type);
        if (records.may_be_cut()) records.fail(kMayBeCut);
      } else {
        skip_property(records, element.properties[p]);
      }
    }
    records.end_record();
    mesh.points.push_back(point);
  }
}

/// The number of corners of the next face, which are then skipped; no more than indices can tell apart.
template <typename Records>
std::size_t skip_corners(Records& records, const PlyProperty& list, std::uint64_t vertex_count) {
  const std::int64_t count = records.integer(*list.list_count);
  if (count < 0) records.fail("a face has a negative number of corners; correct it");
  const auto corners = static_cast<std::uint64_t>(count);
  if (corners > records.most_items(list.type)) {
    records.fail("a face has fewer corners than it announces; the file is cut short");
  }
  records.skip(list.type, count);
  const std::uint64_t nameable = std::min(vertex_count, std::uint64_t{1} << 8 * size_of(list.type));
  if (corners > nameable) {
    records.fail("a face has " + std::to_string(corners) + " corners, its indices can name " +
                 std::to_string(nameable) + " vertices; correct it");
  }
  return corners;
}

/// How many triangles the faces become.
template <typename Records>
std::size_t count_triangles(Records ahead, const PlyElement& element, const PlyLayout& layout) {
  std::size_t triangles = 0;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    ahead.begin_record();
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (p == layout.corner_list) {
        triangles += std::max<std::size_t>(skip_corners(ahead, property, layout.vertex->count), 2) - 2;
      } else {
        skip_property(ahead, property);
      }
    }
  }
  return triangles;
}

/// Room for the triangles at once: growing by doubling would take up to three times as much. Polygons of 18 corners and
/// more whose indices take a byte would still become more than ten times their file; they are refused where they are
/// many, which the faces of a surface are not: they have at most 256 vertices between them.
template <typename Records>
void reserve_triangles(const Records& records, std::size_t triangle_count, std::size_t file_size, MeshData& mesh) {
  constexpr std::size_t kMaxTimes = 10, kAlways = std::size_t{1} << 17;
  const std::size_t bytes =
      mesh.points.capacity() * sizeof(Points::value_type) + triangle_count * sizeof(Triangles::value_type);
  if (bytes > kMaxTimes * file_size + kAlways) {
    records.fail("the polygons become more than ten times the file; export triangles");
  }
  mesh.triangles.reserve(triangle_count);
}

/// Whether more digits could make another vertex of the last corner. trimesh writes no last line break, so that a file
/// without one is read where it can only be whole.
bool begins_another(const std::vector<std::int32_t>& corners, std::uint64_t vertex_count) {
  return !corners.empty() && corners.back() > 0 && 10 * static_cast<std::uint64_t>(corners.back()) < vertex_count;
}

template <typename Records>
void read_faces(Records& records, const PlyElement& element, const PlyLayout& layout, std::size_t file_size,
                MeshData& mesh) {
  const std::uint64_t vertex_count = layout.vertex->count;
  reserve_triangles(records, count_triangles(records, element, layout), file_size, mesh);
  std::vector<std::int32_t> corners;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    records.begin_record();
    for (std::size_t p = 0; p < element.properties.size(); ++p) {
      const PlyProperty& property = element.properties[p];
      if (p != layout.corner_list) {
        skip_property(records, property);
        continue;
      }
      const std::int64_t count = records.integer(*property.list_count);
      corners.clear();
      corners.reserve(static_cast<std::size_t>(count));
      for (std::int64_t k = 0; k < count; ++k) {
        const std::int64_t index = records.integer(property.type);
        if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count) {
          records.fail("vertex " + std::to_string(index) + " of " + std::to_string(vertex_count) +
                       " (counted from 0); correct the index");
        }
        corners.push_back(static_cast<std::int32_t>(index));
      }
      if (records.may_be_cut() && begins_another(corners, vertex_count)) records.fail(kMayBeCut);
      const std::string fault = append_fan(corners, mesh);
      if (!fault.empty()) records.fail(fault);
    }
    records.end_record();
  }
}

const PlyElement* find_element(const LineReader& lines, const PlyHeader& header, std::string_view name) {
  const PlyElement* found = nullptr;
  for (const PlyElement& element : header.elements) {
    if (element.name != name) continue;
    if (found != nullptr) lines.fail_at(element.line, "a second element " + in_quotes(name) + "; remove it");
    found = &element;
  }
  return found;
}

PlyLayout find_layout(const LineReader& lines, const PlyHeader& header) {
  for (const std::string_view unread : {"tristrips", "edge"}) {
    const PlyElement* element = find_element(lines, header, unread);
    if (element != nullptr && element->count > 0) {
      lines.fail_at(element->line, in_quotes(unread) + " is not supported; export polygons only");
    }
  }
  PlyLayout layout;
  layout.vertex = find_element(lines, header, "vertex");
  layout.face = find_element(lines, header, "face");
  if (layout.vertex == nullptr) lines.fail("no element \"vertex\"; is this a mesh?");
  if (layout.face == nullptr) lines.fail("no element \"face\"; export the surface, not the points");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::optional<std::size_t> property = layout.vertex->find({std::string_view("xyz").substr(axis, 1)});
    if (!property || layout.vertex->properties[*property].list_count) {
      lines.fail_at(layout.vertex->line, "the vertices have no numbers x, y, z; add them");
    }
    layout.axes[axis] = *property;
  }
  if (layout.face->find({"vertex_indices"}) && layout.face->find({"vertex_index"})) {
    lines.fail_at(layout.face->line,
                  "the faces have both \"vertex_indices\" and \"vertex_index\"; remove one of the two lists");
  }
  const std::optional<std::size_t> list = layout.face->find({"vertex_indices", "vertex_index"});
  if (!list || !layout.face->properties[*list].list_count || !is_integer(layout.face->properties[*list].type)) {
    lines.fail_at(layout.face->line, "the faces have no list of integers \"vertex_indices\"; add it");
  }
  layout.corner_list = *list;
  return layout;
}

template <typename Records>
MeshData read_elements(Records records, const PlyHeader& header, const PlyLayout& layout, std::size_t file_size) {
  MeshData mesh;
  for (const PlyElement& element : header.elements) {
    if (&element == layout.vertex) {
      read_vertices(records, element, layout.axes, mesh);
    } else if (&element == layout.face) {
      read_faces(records, element, layout, file_size, mesh);
    } else {
      for (std::uint64_t i = 0; i < element.count; ++i) {
        records.begin_record();
        for (const PlyProperty& property : element.properties) skip_property(records, property);
        records.end_record();
      }
    }
  }
  records.end_data();
  const auto is_single = [&](std::size_t p) { return layout.vertex->properties[p].type == PlyType::kFloat32; };
  const bool all_single = std::all_of(layout.axes.begin(), layout.axes.end(), is_single);
  mesh.precision = all_single ? Precision::kFloat32 : Precision::kFloat64;
  return mesh;
}

}  // namespace

MeshData parse_ply(std::string_view bytes, const std::string& name) {
  const FpGuard guard;
  LineReader lines(bytes, name);
  const PlyHeader header = parse_ply_header(lines);
  const PlyLayout layout = find_layout(lines, header);
  if (header.format == PlyFormat::kAscii) return read_elements(AsciiRecords(lines), header, layout, bytes.size());
  const std::endian order = header.format == PlyFormat::kBigEndian ? std::endian::big : std::endian::little;
  const BinaryRecords records(bytes, bytes.size() - lines.rest().size(), name, order);
  return read_elements(records, header, layout, bytes.size());
}

}  // namespace selvage::io
