#include "fuzz/kept/mesh_case.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "fuzz/base/deaths.h"
#include "kernel/assert.h"

namespace selvage::fuzz {
namespace {

/// More would not fit into a file that a person opens.
constexpr std::int64_t kMaxElements = 1 << 20;

std::string format_number(const MeshNumber& number, double x) {
  return number.is_integer ? std::to_string(std::llround(x)) : hex(x);
}

double parse_number(const MeshNumber& number, CaseLines& lines) {
  const std::string_view word = lines.word();
  if (number.is_integer) {
    return static_cast<double>(lines.integer(word, static_cast<std::int64_t>(number.lowest),
                                             static_cast<std::int64_t>(number.highest), number.name));
  }
  const double x = lines.number(word);
  if (!(x >= number.lowest && x <= number.highest)) {
    lines.fail(std::string(number.name) + ": " + std::string(word) + " is not from " + hex(number.lowest) + " to " +
               hex(number.highest));
  }
  return x;
}

std::int64_t parse_count(std::string_view what, std::int64_t lowest, CaseLines& lines) {
  lines.advance();
  lines.expect_word(what);
  const std::int64_t count = lines.integer(lines.word(), lowest, kMaxElements, what);
  lines.expect_end_of_line();
  return count;
}

void parse_vertex(MeshCase& kept, CaseLines& lines) {
  lines.advance();
  lines.expect_word("v");
  for (std::size_t i = 0; i < kept.x.size(); ++i) {
    Positions& x = kept.x[i];
    x.conservativeResize(x.rows() + 1, 3);
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = lines.word();
      const bool may_be_anything = static_cast<int>(i) > kept.kind->last_finite;
      x(x.rows() - 1, axis) = may_be_anything ? lines.any_number(word) : lines.number(word);
    }
  }
  for (std::size_t i = 0; i < kept.marks.size(); ++i) {
    kept.marks[i].push_back(parse_number(kept.kind->marks[i], lines));
  }
  lines.expect_end_of_line();
}

std::array<std::int32_t, 3> parse_face(const MeshCase& kept, CaseLines& lines) {
  lines.advance();
  lines.expect_word("f");
  std::array<std::int32_t, 3> face{};
  const std::int64_t last = static_cast<std::int64_t>(kept.vertex_count()) - 1;
  for (std::int32_t& corner : face) {
    corner = static_cast<std::int32_t>(lines.integer(lines.word(), 0, last, "vertex of a face"));
  }
  if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0])
    lines.fail("a face names a vertex twice; correct it");
  lines.expect_end_of_line();
  return face;
}

}  // namespace

double MeshCase::setting(std::string_view name) const {
  const auto found = std::ranges::find(kind->settings, name, &MeshNumber::name);
  SELVAGE_ASSERT(found != kind->settings.end());
  return settings[static_cast<std::size_t>(found - kind->settings.begin())];
}

std::string KeptMesh::body() const {
  std::string text;
  for (std::size_t i = 0; i < mesh_.settings.size(); ++i) {
    const MeshNumber& setting = mesh_.kind->settings[i];
    text += "set " + std::string(setting.name) + " " + format_number(setting, mesh_.settings[i]) + "\n";
  }
  text += "# a vertex:";
  for (const std::string_view instant : mesh_.kind->instants) text += " " + std::string(instant) + ",";
  for (const MeshNumber& mark : mesh_.kind->marks) text += " " + std::string(mark.name) + ",";
  text.back() = '\n';
  text += "vertices " + std::to_string(mesh_.vertex_count()) + "\n";
  for (std::size_t v = 0; v < mesh_.vertex_count(); ++v) {
    text += "v";
    for (const Positions& x : mesh_.x) {
      for (int axis = 0; axis < 3; ++axis) text += " " + hex(x(static_cast<Eigen::Index>(v), axis));
      text += " ";
    }
    for (std::size_t i = 0; i < mesh_.marks.size(); ++i) {
      text += " " + format_number(mesh_.kind->marks[i], mesh_.marks[i][v]);
    }
    text += "\n";
  }
  text += "faces " + std::to_string(mesh_.faces.size()) + "\n";
  for (const auto& [a, b, c] : mesh_.faces) {
    text += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(c) + "\n";
  }
  return text;
}

Retrial retry(const MeshCase& kept) {
  try {
    return kept.kind->retry(kept);
  } catch (const std::exception& error) {
    return {kThrew, {error.what()}, {}};
  }
}

Retrial KeptMesh::retry() const { return fuzz::retry(mesh_); }

MeshCase parse_mesh_case(const MeshKind& kind, CaseLines& lines) {
  MeshCase kept;
  kept.kind = &kind;
  for (const MeshNumber& setting : kind.settings) {
    lines.advance();
    lines.expect_word("set");
    lines.expect_word(setting.name);
    kept.settings.push_back(parse_number(setting, lines));
    lines.expect_end_of_line();
  }
  kept.x.resize(kind.instants.size());
  kept.marks.resize(kind.marks.size());
  for (std::int64_t left = parse_count("vertices", 1, lines); left > 0; --left) parse_vertex(kept, lines);
  for (std::int64_t left = parse_count("faces", 1, lines); left > 0; --left) {
    kept.faces.push_back(parse_face(kept, lines));
  }
  if (!lines.only_blank_left()) lines.fail("nothing may follow the faces; remove it");
  return kept;
}

}  // namespace selvage::fuzz
