#include "fuzz/kept/kept_case.h"

#include "fuzz/kept/broad_case.h"
#include "fuzz/kept/byte_case.h"
#include "fuzz/kept/collisions_case.h"
#include "fuzz/kept/drawn_case.h"
#include "fuzz/kept/file_case.h"
#include "fuzz/kept/mesh_case.h"
#include "fuzz/kept/scene_case.h"
#include "fuzz/kept/step_case.h"
#include "fuzz/kept/subdivision_case.h"

namespace selvage::fuzz {
namespace {

std::string word_line(std::string_view key, CaseLines& lines) {
  lines.advance();
  lines.expect_word(key);
  std::string word(lines.word());
  lines.expect_end_of_line();
  return word;
}

std::string parse_head(CaseLines& lines) {
  lines.expect_head();
  return std::string(lines.word());
}

/// Of those that hold their case.
const MeshKind* mesh_kind(const std::string& name) {
  for (const MeshKind* kind : {&step_kind(), &broad_kind(), &collisions_kind(), &subdivision_kind()}) {
    if (kind->name == name) return kind;
  }
  return nullptr;
}
const ByteKind* byte_kind(const std::string& name) {
  for (const ByteKind* kind : {&scene_kind(), &file_kind()}) {
    if (kind->name == name) return kind;
  }
  return nullptr;
}

}  // namespace

std::string kept_text(const KeptCase& kept, const std::string& origin, const std::string& failure) {
  return "selvage-case 1 " + kept.kind() + "\nseed " + origin + "\nfailure " + failure + "\n" + kept.body();
}

ParsedCase parse_kept_case(std::string_view text, const std::string& name, const Redraw& redraw) {
  CaseLines lines(text, name);
  const std::string kind = parse_head(lines);
  const MeshKind* mesh = mesh_kind(kind);
  const ByteKind* bytes = byte_kind(kind);
  if (mesh == nullptr && bytes == nullptr && kind != kDrawn) {
    lines.fail("there is no kind of case '" + kind + "' here; replay it with the selvage that wrote it");
  }
  lines.expect_end_of_line();
  ParsedCase parsed;
  parsed.origin = word_line("seed", lines);
  parsed.failure = word_line("failure", lines);
  if (mesh != nullptr) {
    parsed.kept = std::make_unique<KeptMesh>(parse_mesh_case(*mesh, lines));
  } else if (bytes != nullptr) {
    parsed.kept = std::make_unique<KeptBytes>(parse_byte_case(*bytes, lines));
  } else {
    parsed.kept = parse_drawn_case(parsed.origin, redraw, lines);
  }
  return parsed;
}

std::string kind_of_case(std::string_view text, const std::string& name) {
  CaseLines lines(text, name);
  return parse_head(lines);
}

}  // namespace selvage::fuzz
