#include "sim/scene/surface_reader.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

namespace selvage::sim {
namespace {

constexpr std::int64_t kMaxSide = 10'000;  // 10^8 vertices: more than memory holds

/// What `read` makes of the whole table.
template <class Read>
auto read_whole(TomlTable& table, Read read) {
  auto result = read(table);
  table.finish();
  return result;
}

SheetSpec read_sheet(TomlTable& table) {
  table.know_only({"nx", "ny", "width_m", "height_m"});
  SheetSpec sheet;
  sheet.nx = static_cast<std::int32_t>(table.integer("nx", 2, kMaxSide));
  sheet.ny = static_cast<std::int32_t>(table.integer("ny", 2, kMaxSide));
  sheet.width_m = table.number("width_m", kLength);
  sheet.height_m = table.number("height_m", kLength);
  return sheet;
}

SphereSpec read_sphere(TomlTable& table) {
  table.know_only({"radius_m", "subdivisions"});
  SphereSpec sphere;
  sphere.radius_m = table.number("radius_m", kLength);
  sphere.subdivisions = static_cast<std::int32_t>(table.integer("subdivisions", 0, 8, sphere.subdivisions));
  return sphere;
}

EllipsoidSpec read_ellipsoid(TomlTable& table) {
  table.know_only({"size_m", "subdivisions"});
  EllipsoidSpec ellipsoid;
  ellipsoid.size_m = table.vector("size_m", kLength);
  ellipsoid.subdivisions = static_cast<std::int32_t>(table.integer("subdivisions", 0, 8, ellipsoid.subdivisions));
  return ellipsoid;
}

CapsuleSpec read_capsule(TomlTable& table) {
  table.know_only({"end_m", "radius_m", "end_radius_m", "segments"});
  CapsuleSpec capsule;
  capsule.end_m = table.vector("end_m", kCoordinate);
  capsule.radius_m = table.number("radius_m", kLength);
  capsule.end_radius_m = table.number("end_radius_m", kLength, capsule.radius_m);
  capsule.segments = static_cast<std::int32_t>(table.integer("segments", 3, 1000, capsule.segments));
  if (!(capsule.end_m.norm() > std::abs(capsule.radius_m - capsule.end_radius_m))) {
    table.fail("end_m", "one end of the capsule holds the other; move end_m out, or use a sphere");
  }
  return capsule;
}

BoxSpec read_box(TomlTable& table) {
  table.know_only({"size_m", "cells"});
  BoxSpec box;
  box.size_m = table.vector("size_m", kLength);
  box.cells = static_cast<std::int32_t>(table.integer("cells", 1, 1000, box.cells));
  return box;
}

GarmentSpec::Sleeves read_sleeves(TomlTable& table) {
  table.know_only({"top_m", "bottom_m", "depth_m", "length_m", "cuff_radius_m", "down_deg"});
  GarmentSpec::Sleeves sleeves;
  sleeves.top_m = table.number("top_m", kCoordinate);
  sleeves.bottom_m = table.number("bottom_m", kCoordinate);
  sleeves.depth_m = table.number("depth_m", kLength);
  sleeves.length_m = table.number("length_m", kLength);
  sleeves.cuff_radius_m = table.number("cuff_radius_m", kLength);
  sleeves.down_deg = table.number("down_deg", {-90, 90}, 0);
  return sleeves;
}

GarmentSpec::Ring read_ring(TomlTable& table) {
  table.know_only({"height_m", "depth_m", "width_m"});
  GarmentSpec::Ring ring;
  ring.height_m = table.number("height_m", kCoordinate);
  ring.depth_m = table.number("depth_m", kLength);
  ring.width_m = table.number("width_m", kLength);
  return ring;
}

GarmentSpec read_garment(TomlTable& table) {
  table.know_only({"ring", "sleeves", "cell_m"});
  GarmentSpec garment;
  for (TomlTable& entry : table.tables("ring")) {
    const GarmentSpec::Ring ring = read_whole(entry, read_ring);
    if (!garment.rings.empty() && !(ring.height_m < garment.rings.back().height_m)) {
      entry.fail("height_m", "height_m must fall from ring to ring; list them from the top down");
    }
    garment.rings.push_back(ring);
  }
  if (garment.rings.size() < 2) table.fail("a garment needs two rings or more, from the top down");
  garment.sleeves_line = table.line("sleeves");
  if (std::optional<TomlTable> sleeves = table.table("sleeves")) garment.sleeves = read_whole(*sleeves, read_sleeves);
  double largest_m = garment.rings.front().height_m - garment.rings.back().height_m;
  for (const GarmentSpec::Ring& ring : garment.rings) {
    largest_m = std::max({largest_m, ring.depth_m, ring.width_m});
  }
  if (garment.sleeves) largest_m = std::max(largest_m, garment.sleeves->length_m);
  garment.cell_m = table.number("cell_m", {largest_m / double(kMaxSide), kLength.upper});
  return garment;
}

std::string read_file_name(TomlTable& table) {
  std::string file = table.text("file");
  if (file.empty()) table.fail("file", "file is empty; name one, relative to the scene file");
  return file;
}

MeshSpec read_mesh_spec(TomlTable& table) {
  table.know_only({"file", "scale"});
  MeshSpec mesh;
  mesh.file = read_file_name(table);
  mesh.line = table.line("file");
  mesh.scale = table.number("scale", kPositive, mesh.scale);
  return mesh;
}

SequenceSpec read_sequence_spec(TomlTable& table) {
  table.know_only({"file", "base", "scale", "frames_per_s", "start_s"});
  SequenceSpec sequence;
  sequence.file = read_file_name(table);
  sequence.line = table.line("file");
  sequence.base = table.text("base", "");
  sequence.scale = table.number("scale", kPositive, sequence.scale);
  if (table.has("frames_per_s")) sequence.frames_per_s = table.number("frames_per_s", {1e-6, 1e6});
  sequence.start_s = table.number("start_s", {-1e9, 1e9}, 0);
  return sequence;
}

// Takes the one table of its owner that names a surface.
template <class AnySurface>
class SurfaceChoice {
 public:
  explicit SurfaceChoice(TomlTable& owner) : owner_(owner) {}

  template <class Read>
  void take(std::string_view key, Read read) {
    std::optional<TomlTable> table = owner_.table(key);
    if (!table) return;
    if (surface_) owner_.fail(key, fmt::format("{} is a second surface; keep one", key));
    surface_ = read_whole(*table, read);
  }
  [[nodiscard]] AnySurface chosen(std::string_view choices) const {
    if (!surface_) owner_.fail(fmt::format("no surface; add a table {}", choices));
    return *surface_;
  }

 private:
  TomlTable& owner_;
  std::optional<AnySurface> surface_;
};

}  // namespace

Surface read_cloth_surface(TomlTable& cloth) {
  SurfaceChoice<Surface> choice(cloth);
  choice.take("sheet", read_sheet);
  choice.take("garment", read_garment);
  choice.take("mesh", read_mesh_spec);
  return choice.chosen("sheet, garment or mesh");
}

BodySurface read_body_surface(TomlTable& body) {
  SurfaceChoice<BodySurface> choice(body);
  choice.take("sheet", read_sheet);
  choice.take("mesh", read_mesh_spec);
  choice.take("sequence", read_sequence_spec);
  choice.take("sphere", read_sphere);
  choice.take("ellipsoid", read_ellipsoid);
  choice.take("capsule", read_capsule);
  choice.take("box", read_box);
  return choice.chosen("sheet, sphere, ellipsoid, capsule, box, mesh or sequence");
}

}  // namespace selvage::sim
